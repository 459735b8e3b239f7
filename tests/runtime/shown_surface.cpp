#include "runtime/shown_surface.h"

#include "base/assert.h"
#include "codec/checksum.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <vector>

namespace crease {

namespace {

using Corner = std::array<float, 3>;

// Along the edge from the smaller end to the larger one, or back.
struct Edge {
  Corner low, high;
  bool is_forward = false;

  bool has_ends_of(const Edge& other) const { return low == other.low && high == other.high; }
};

class EdgeCollector {
 public:
  void add(const DrawList& list, const DrawPart& part, const Range& range) {
    for (std::size_t t = range.first; t < std::size_t(range.first) + range.count; ++t) {
      std::array<Corner, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f& p = list.positions[part.indices[3 * t + k]];
        corners[k] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // no -0
      }
      for (std::size_t k = 0; k < 3; ++k) add_edge(corners[k], corners[(k + 1) % 3]);
    }
  }

  // How many of them lack one the other way.
  std::size_t count_open() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    std::size_t open = 0;
    for (std::size_t i = 0; i < edges_.size();) {
      const Edge& first = edges_[i];
      std::ptrdiff_t forward = 0, back = 0;
      for (; i < edges_.size() && edges_[i].has_ends_of(first); ++i) {
        ++(edges_[i].is_forward ? forward : back);
      }
      open += std::size_t(std::max(forward, back) - std::min(forward, back));
    }
    return open;
  }

 private:
  void add_edge(const Corner& from, const Corner& to) {
    if (from < to) edges_.push_back({from, to, true});
    if (to < from) edges_.push_back({to, from, false});
  }

  std::vector<Edge> edges_;
};

Range all_of(const DrawPart& part) {
  return {0, static_cast<std::uint32_t>(part.triangle_count())};
}

}  // namespace

std::size_t open_edges(const BlockMesh& mesh) {
  EdgeCollector edges;
  for (const ShownRange& range : mesh.shown()) {
    const DrawList list = range.block->draw_list();
    edges.add(list, list.sn, range.sn);
    edges.add(list, list.fn, range.fn);
    edges.add(list, list.nsn, range.nsn);
  }
  for (const ShownCut& cut : mesh.shown_cuts()) {
    for (const DrawPart* part : {&cut.list.sn, &cut.list.fn, &cut.list.nsn}) {
      edges.add(cut.list, *part, all_of(*part));
    }
  }
  return edges.count_open();
}

std::uint64_t drawn_checksum(const ResidentBlock& block) {
  const DrawList list = block.draw_list();
  std::vector<std::uint64_t> sums{checksum(std::as_bytes(list.positions)),
                                  checksum(std::as_bytes(list.vertex_normals))};
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    sums.push_back(checksum(std::as_bytes(part->indices)));
    sums.push_back(checksum(std::as_bytes(part->normals)));
    sums.push_back(checksum(std::as_bytes(part->materials)));
    sums.push_back(checksum(std::as_bytes(part->colors)));
    sums.push_back(checksum(std::as_bytes(part->texcoords)));
  }
  return checksum(std::as_bytes(std::span(sums)));
}

Result<std::vector<std::uint64_t>> drawn_checksums(const BlockFile& file) {
  Result<BlockMesh> mesh = BlockMesh::open(file);
  if (!mesh.ok()) return mesh.failure();
  std::vector<std::uint64_t> checksums;
  while (const std::optional<std::uint32_t> next = mesh->next_page()) {
    const Result<DirectoryPage> page = file.read_page(*next);
    if (!page.ok()) return page.failure();
    if (Status status = mesh->add_page(*page); !status.ok()) return status.failure();
    for (const BlockEntry& entry : page->blocks) {
      const Result<std::vector<std::byte>> payload = file.read_block(entry);
      if (!payload.ok()) return payload.failure();
      const std::optional<BlockDecodeJob> job = mesh->decode_job(entry.id);
      CREASE_ASSERT(job.has_value());  // all that it needs lies before it
      const Result<ResidentBlockPtr> block = job->run(*payload);
      if (!block.ok()) return block.failure();
      checksums.push_back(drawn_checksum(**block));
      mesh->insert(*block);
    }
  }
  return checksums;
}

std::size_t wrong_blocks(const BlockMesh& mesh, std::span<const std::uint64_t> checksums) {
  std::set<const ResidentBlock*> shown;
  for (const ShownRange& range : mesh.shown()) shown.insert(range.block);
  for (const ShownCut& cut : mesh.shown_cuts()) shown.insert(cut.block);
  std::size_t wrong = 0;
  for (const ResidentBlock* block : shown) {
    wrong += drawn_checksum(*block) != checksums[index_of(block->id())];
  }
  return wrong;
}

}  // namespace crease

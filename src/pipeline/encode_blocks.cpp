#include "pipeline/encode_blocks.h"

#include "parallel/parallel.h"
#include "parallel/shared_progress.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

// What a fine end is in terms of the input.
struct EndIds {
  BlockId block{};
  std::vector<std::uint32_t> vertex_ids, triangle_ids;
};

// Where in a patch's plan an input id is; of the ids of other patches, anything.
struct PlanIndices {
  std::vector<std::uint32_t> of_vertex, of_triangle;
};

void number(std::vector<std::uint32_t>& index, const std::vector<std::uint32_t>& ids) {
  for (std::uint32_t i = 0; i < ids.size(); ++i) {
    if (ids[i] >= index.size()) index.resize(ids[i] + 1);
    index[ids[i]] = i;
  }
}

std::vector<std::uint32_t> of_each(const std::vector<std::uint32_t>& ids,
                                   const std::vector<std::uint32_t>& indices) {
  std::vector<std::uint32_t> result;
  result.reserve(indices.size());
  for (const std::uint32_t i : indices) result.push_back(ids[i]);
  return result;
}

// A sphere around all places where a vertex of the block ever stands.
void bound(const codec::BlockPlan& plan, BlockFacts& facts) {
  std::vector<Vec3i> places = plan.fine.positions;
  for (const codec::BlockPlan::Step& step : plan.steps) places.push_back(step.position);
  if (places.empty()) return;
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(
        places.begin(), places.end(), [k](const Vec3i& a, const Vec3i& b) { return a[k] < b[k]; });
    facts.center[k] =
        static_cast<std::int32_t>((std::int64_t((*low)[k]) + std::int64_t((*high)[k])) / 2);
  }
  for (const Vec3i& p : places) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = double(p[k]) - double(facts.center[k]);
      sum += d * d;
    }
    squared = std::max(squared, sum);
  }
  facts.radius = static_cast<std::uint32_t>(std::ceil(std::sqrt(squared) + 1e-6));
}

constexpr std::uint16_t kFinest = 0;  // nobody starts from where this band ends

class BandEncoder {
 public:
  BandEncoder(const codec::BlockCoding& coding) : coding_(coding) {}

  // `band`: as the file counts.
  void encode(const BandPlans& plans, std::uint16_t band, std::vector<CodedBlock>& blocks,
              SharedProgress& progress) {
    const std::size_t patches = plans.plans.size();
    std::vector<codec::CoarseEnd> starts =
        codec::sort_by_label(ends_, static_cast<std::uint32_t>(patches));
    std::vector<codec::FineEnd> ends(patches);
    std::vector<EndIds> ids(patches);
    const std::uint32_t first = static_cast<std::uint32_t>(blocks.size());
    blocks.resize(first + patches);
    parallel_for(patches, [&](std::size_t p) {
      if (progress.stopped()) return;
      CodedBlock& block = blocks[first + p];
      block.facts.band = band;
      block.facts.patch = static_cast<std::uint32_t>(p);
      ids[p].block = BlockId{first + static_cast<std::uint32_t>(p)};
      encode_patch(plans, p, std::move(starts[p]), block, ends[p], ids[p]);
      progress.advance(block.facts.triangles_fine);
    });
    if (band == kFinest || progress.stopped()) return;
    ends_ = std::move(ends);
    ids_ = std::move(ids);
    for (std::size_t e = 0; e < ends_.size(); ++e) {
      for (std::size_t v = 0; v < ends_[e].names.size(); ++v) {
        const std::uint32_t id = ids_[e].vertex_ids[v];
        if (id >= names_.size()) names_.resize(id + 1, {kNone, 0});
        names_[id] = ends_[e].names[v];
      }
    }
  }

 private:
  void encode_patch(const BandPlans& plans, std::size_t p, codec::CoarseEnd start,
                    CodedBlock& block, codec::FineEnd& end, EndIds& ids) {
    const codec::BlockPlan plan = plans.plan(p);
    PlanIndices& index = indices_.local();
    number(index.of_vertex, plans.vertex_ids[p]);
    number(index.of_triangle, plans.triangle_ids[p]);
    std::vector<std::uint32_t> triangles, vertices(start.mesh.positions.size());
    for (std::size_t t = 0; t < start.sources.size(); ++t) {
      const auto [e, triangle] = start.sources[t];
      triangles.push_back(index.of_triangle[ids_[e].triangle_ids[triangle]]);
      for (std::size_t c = 0; c < 3; ++c) {
        vertices[start.mesh.triangles[t][c]] =
            index.of_vertex[ids_[e].vertex_ids[ends_[e].mesh.triangles[triangle][c]]];
      }
      if (block.dependencies.empty() || block.dependencies.back() != ids_[e].block) {
        block.dependencies.push_back(ids_[e].block);
      }
    }
    // What a coarser block made, and this one has no triangle of at the coarse end.
    std::vector<codec::VertexName> names;
    for (const std::uint32_t id : plans.vertex_ids[p]) {
      names.push_back(id < names_.size() ? names_[id] : codec::VertexName{kNone, 0});
    }
    if (!plans.roots.empty()) {
      for (const std::uint32_t id : plans.roots[p]) {
        if (id < names_.size() && names_[id].block != kNone) {
          block.dependencies.push_back(BlockId{names_[id].block});
        }
      }
      std::sort(block.dependencies.begin(), block.dependencies.end());
      block.dependencies.erase(std::unique(block.dependencies.begin(), block.dependencies.end()),
                               block.dependencies.end());
    }
    BlockFacts& facts = block.facts;
    facts.splits = static_cast<std::uint32_t>(plan.steps.size());
    facts.vertices = static_cast<std::uint32_t>(plan.fine.positions.size());
    facts.triangles_coarse = static_cast<std::uint32_t>(triangles.size());
    facts.triangles_fine = static_cast<std::uint32_t>(plan.fine.triangles.size());
    facts.coarse = plans.errors[p].coarse;
    facts.fine = plans.errors[p].fine;
    facts.decoded_bytes =
        static_cast<std::uint32_t>(codec::decoded_bytes(block.limits(), coding_.layers.size()));
    bound(plan, facts);

    codec::EncodedBlock encoded =
        codec::encode_block(plan, static_cast<std::uint32_t>(index_of(ids.block)), coding_,
                            std::move(start), triangles, vertices, names);
    block.bytes = std::move(encoded.bytes);
    if (facts.band == kFinest) return;
    ids.vertex_ids = of_each(plans.vertex_ids[p], encoded.plan_of_vertex);
    ids.triangle_ids = of_each(plans.triangle_ids[p], encoded.plan_of_triangle);
    end = std::move(encoded.decoded.end);
  }

  const codec::BlockCoding& coding_;
  std::vector<codec::FineEnd> ends_;  // of the band before
  std::vector<EndIds> ids_;
  std::vector<codec::VertexName> names_;  // per vertex of the input, while it stands
  PerThread<PlanIndices> indices_;
};

}  // namespace

Result<std::vector<CodedBlock>> encode_blocks(std::vector<BandPlans> plans,
                                              const codec::BlockCoding& coding,
                                              const ProgressCallback& progress) {
  std::size_t triangles = 0;
  for (const BandPlans& band : plans) {
    for (const std::vector<std::uint32_t>& ids : band.triangle_ids) triangles += ids.size();
  }
  SharedProgress told(progress, "encode", triangles);
  std::vector<CodedBlock> blocks;
  BandEncoder encoder(coding);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    encoder.encode(plans[i], static_cast<std::uint16_t>(plans.size() - 1 - i), blocks, told);
    if (told.stopped()) return fail(Error::Interrupted, "encode: interrupted");
    plans[i] = {};
  }
  return blocks;
}

}  // namespace crease

#include "codec/patch_lines.h"

#include "crease/ids.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace crease::codec {

using simplification::Quadric;

namespace {

// Between two faces an edge is a line only where the surface really bends (30 degrees): where all
// is flat, every edge is hard, and few are features.
constexpr double kFlatLineCosine = 0.866;

class LineFinder {
 public:
  LineFinder(const PatchMesh& mesh, const BlockCoding& coding, const ContractingPatch& patch,
             const PatchGeometry& geometry, std::span<const char> is_contracted,
             std::span<const char> is_face, const WedgeQuadrics& wedges)
      : mesh_(mesh),
        coding_(coding),
        patch_(patch),
        geometry_(geometry),
        is_contracted_(is_contracted),
        is_face_(is_face),
        has_several_(wedges.has_several()) {
    for (std::size_t l = 0; l < coding.layers.size(); ++l) {
      if (!wedges.has_wedges(l)) without_wedges_.push_back(&mesh.values[l]);
    }
    for (const BlockLayer& layer : coding.layers) has_normals_ = has_normals_ || layer.is_normal;
    is_plain_.resize(mesh.positions.size());
    for (std::uint32_t v = 0; v < is_plain_.size(); ++v) is_plain_[v] = is_plain(v);
  }

  // Calls add(v, w, triangle) for every triangle at an edge that is a line, of those with an end
  // that is contracted.
  template <typename Add>
  void find(const Add& add) {
    for (std::uint32_t v = 0; v < is_plain_.size(); ++v) {
      if (is_plain_[v]) continue;  // then its edges are lines only by the other end
      list_edges(v);
      for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
        const std::uint32_t to = edges_[begin].to();
        while (end < edges_.size() && edges_[end].to() == to) ++end;
        if (end == begin + 2 &&
            is_smooth(v, to, edges_[begin].triangle(), edges_[begin + 1].triangle())) {
          continue;
        }
        for (std::size_t i = begin; i < end; ++i) add(v, to, edges_[i].triangle());
      }
    }
  }

 private:
  struct Edge {  // by the vertex across, then by the triangle
    std::uint64_t key = 0;
    std::uint32_t to() const { return static_cast<std::uint32_t>(key >> 32); }
    std::uint32_t triangle() const { return static_cast<std::uint32_t>(key); }
    bool operator<(const Edge& o) const { return key < o.key; }
  };

  // The triangles at v and the vertices across, by those; but none that was listed before. Without
  // branches, since nobody can tell which are.
  void list_edges(std::uint32_t v) {
    const std::span<const std::uint32_t> around = patch_.around(v);
    edges_.resize(2 * around.size());
    std::size_t count = 0;
    for (const std::uint32_t t : around) {
      const Corners& corners = mesh_.triangles[t];
      const std::size_t c = corner_of(corners, v);
      for (const std::uint32_t w : {corners[kCornerAfter[c]], corners[kCornerBefore[c]]}) {
        edges_[count] = {std::uint64_t(w) << 32 | t};
        const bool is_contracted = (is_contracted_[v] | is_contracted_[w]) != 0;
        count += is_contracted & (unsigned(w > v) | unsigned(is_plain_[w] != 0));
      }
    }
    edges_.resize(count);
    std::sort(edges_.begin(), edges_.end());
  }

  // Two triangles at each edge, all of one category, with one value of each layer at v, and no face
  // that could bend: an edge between two such vertices is smooth. Some that are so are left out.
  bool is_plain(std::uint32_t v) const {
    const std::span<const std::uint32_t> around = patch_.around(v);
    if (around.empty() || has_several_[v]) return false;
    // The next vertices are all different, and the last ones are the same, if sums tell: then each
    // is the next one of one triangle and the last one of another.
    std::array<std::uint64_t, 4> seen{};
    std::uint64_t again = 0, sum = 0;
    const std::uint32_t category = mesh_.category[around[0]];
    bool is_one = true;
    for (const std::uint32_t t : around) {
      const Corners& corners = mesh_.triangles[t];
      const std::size_t c = corner_of(corners, v);
      const std::uint32_t next = corners[kCornerAfter[c]], last = corners[kCornerBefore[c]];
      const std::uint64_t bit = std::uint64_t(1) << (next & 63);
      std::uint64_t& word = seen[next >> 6 & 3];
      again |= word & bit;
      word |= bit;
      sum += mixed(next) - mixed(last);
      is_one = is_one && mesh_.category[t] == category;
      if (has_normals_) is_one = is_one && !is_face_[t];
    }
    if (again != 0 || sum != 0 || !is_one) return false;
    for (const std::vector<CodedValue>* values : without_wedges_) {
      const CodedValue& first = value(*values, around[0], v);
      for (const std::uint32_t t : around) is_one = is_one && value(*values, t, v) == first;
    }
    return is_one;
  }

  static std::uint64_t mixed(std::uint64_t x) {
    x *= 0x9e3779b97f4a7c15u;
    return (x ^ x >> 29) * 0xbf58476d1ce4e5b9u;
  }

  // Of the edge from v to w, with triangles t and u.
  bool is_smooth(std::uint32_t v, std::uint32_t w, std::uint32_t t, std::uint32_t u) const {
    if (mesh_.category[t] != mesh_.category[u]) return false;
    for (std::size_t l = 0; l < coding_.layers.size(); ++l) {
      if (coding_.layers[l].is_normal && is_face_[t] && is_face_[u]) {
        if (bends(t, u)) return false;
        continue;
      }
      if (coding_.layers[l].is_normal && (mesh_.derived[t] || mesh_.derived[u])) continue;
      for (const std::uint32_t end : {v, w}) {
        const std::vector<CodedValue>& values = mesh_.values[l];
        if (value(values, t, end) != value(values, u, end)) return false;
      }
    }
    return true;
  }

  bool bends(std::uint32_t t, std::uint32_t u) const {
    const ScaledNormal &a = geometry_.normal(t), &b = geometry_.normal(u);
    return a.size > 0 && b.size > 0 && dot(a.unit, b.unit) < kFlatLineCosine;
  }

  const CodedValue& value(const std::vector<CodedValue>& values, std::uint32_t t,
                          std::uint32_t v) const {
    return values[3 * std::size_t(t) + corner_of(mesh_.triangles[t], v)];
  }

  const PatchMesh& mesh_;
  const BlockCoding& coding_;
  const ContractingPatch& patch_;
  const PatchGeometry& geometry_;
  std::span<const char> is_contracted_, is_face_, has_several_;
  std::vector<const std::vector<CodedValue>*> without_wedges_;
  bool has_normals_ = false;
  std::vector<char> is_plain_;
  std::vector<Edge> edges_;  // scratch
};

}  // namespace

PatchLines::PatchLines(const UnfoldedBlock& block, const BlockCoding& coding,
                       const ContractingPatch& patch, const PatchGeometry& geometry,
                       std::span<const char> is_contracted, std::span<const char> is_face,
                       const WedgeQuadrics& wedges)
    : line_of_vertex_(block.end.positions.size(), kNone) {
  const auto add = [&](std::uint32_t v, std::uint32_t w, std::uint32_t t) {
    const Vec3d& a = geometry.place(v);
    const Vec3d along = geometry.place(w) - a, across = cross(along, geometry.normal(t).unit);
    const double size = length(across);
    if (size == 0) return;
    const Vec3d unit = across * (1 / size);
    Quadric plane;
    plane.weight = dot(along, along);
    plane.add_plane(unit, -dot(unit, a), plane.weight);
    for (const std::uint32_t end : {v, w}) {
      if (!is_contracted[end]) continue;
      if (line_of_vertex_[end] == kNone) {
        line_of_vertex_[end] = static_cast<std::uint32_t>(lines_.size());
        lines_.emplace_back();
      }
      lines_[line_of_vertex_[end]].add(plane);
    }
  };
  LineFinder(block.end, coding, patch, geometry, is_contracted, is_face, wedges).find(add);
}

const Quadric* PatchLines::join(std::uint32_t first, std::uint32_t second) {
  std::uint32_t& line = line_of_vertex_[first];
  const std::uint32_t other = line_of_vertex_[second];
  if (line == kNone) {
    line = other;
  } else if (other != kNone) {
    lines_[line].add(lines_[other]);
  }
  return line == kNone ? nullptr : &lines_[line];
}

}  // namespace crease::codec

#include "assemble/leaf_wedges.h"

#include "mesh/disjoint_sets.h"
#include "mesh/smooth_regions.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace crease {

namespace {

// Smooth regions, joined where they have an attribute in common anywhere: what has equal indices is
// one when it meets, so it needs one place in the order. With G03's regions alone 3 % of the parent
// maps of berlin_52k cross, and 10 % of fzk_haus; so none.
std::vector<std::uint32_t> ordering_regions(const Mesh& mesh, const CornersAround& around,
                                            const AttributeLayer& layer) {
  const std::vector<std::uint32_t> smooth = smooth_regions(mesh, around, layer);
  DisjointSets joined(mesh.triangle_count());
  std::vector<std::uint32_t> region_of_id(layer.value_count(), kNone);
  for (std::size_t c = 0; c < layer.of_corner.size(); ++c) {
    std::uint32_t& region = region_of_id[index_of(layer.of_corner[c])];
    if (region == kNone) region = smooth[c / 3];
    joined.unite(region, smooth[c / 3]);
  }
  std::vector<std::uint32_t> regions;
  for (std::uint32_t region : smooth) regions.push_back(joined.find(region));
  return regions;
}

bool is_face_value(const AttributeLayer& layer, std::uint32_t corner) {
  const AttributeId* id = &layer.of_corner[corner - corner % 3];
  return id[0] == id[1] && id[1] == id[2];
}

// The attributes at one vertex, appended in the order of their regions.
void add_attributes(const AttributeLayer& layer, const std::vector<std::uint32_t>& region,
                    std::span<const std::uint32_t> corners, LeafAttributes& leaves) {
  using Attribute = LeafAttributes::Attribute;
  std::vector<Attribute>& all = leaves.attributes;
  const auto first = static_cast<std::ptrdiff_t>(all.size());
  for (std::uint32_t c : corners) {
    all.push_back({layer.of_corner[c], region[c / 3], c, is_face_value(layer, c)});
  }
  // One of each: same ids beside each other, the smallest region and corner first.
  const auto order = [](const Attribute& a) { return std::tuple(a.id, a.region, a.corner); };
  std::sort(all.begin() + first, all.end(),
            [&](const Attribute& a, const Attribute& b) { return order(a) < order(b); });
  auto last = all.begin() + first;
  for (auto a = all.begin() + first; a != all.end(); ++a) {
    if (a == all.begin() + first) continue;
    if (a->id == last->id) {
      last->is_face_value = last->is_face_value || a->is_face_value;
      last->corner = std::min(last->corner, a->corner);
    } else {
      *++last = *a;
    }
  }
  if (!corners.empty()) all.erase(last + 1, all.end());
  std::sort(all.begin() + first, all.end(), [](const Attribute& a, const Attribute& b) {
    return std::tuple(a.region, a.corner) < std::tuple(b.region, b.corner);
  });
  leaves.first_of_vertex.push_back(static_cast<std::uint32_t>(all.size()));
}

// Where the attributes of one vertex are, by their ids.
class PlaceOfId {
 public:
  // Of the last vertex added.
  void look_at(const LeafAttributes& leaves, std::size_t v) {
    first_ = leaves.first_of_vertex[v];
    attributes_ = std::span(leaves.attributes).subspan(first_);
    by_id_.clear();
    if (attributes_.size() <= kFew) return;
    for (std::uint32_t i = 0; i < attributes_.size(); ++i)
      by_id_.emplace_back(attributes_[i].id, i);
    std::sort(by_id_.begin(), by_id_.end());
  }
  std::uint32_t operator[](AttributeId id) const {
    if (!by_id_.empty()) {
      return first_ + std::lower_bound(by_id_.begin(), by_id_.end(), std::pair(id, 0u))->second;
    }
    std::uint32_t i = 0;
    while (attributes_[i].id != id) ++i;
    return first_ + i;
  }

 private:
  static constexpr std::size_t kFew = 16;  // else a pole of many takes the square of time
  std::uint32_t first_ = 0;
  std::span<const LeafAttributes::Attribute> attributes_;
  std::vector<std::pair<AttributeId, std::uint32_t>> by_id_;
};

class WedgeFinder {
 public:
  explicit WedgeFinder(const Mesh& mesh) : mesh_(mesh), around_(mesh) {}

  LeafWedges run(const VertexForest& forest, VertexHierarchy& hierarchy) {
    prepare();
    std::vector<std::uint32_t> count_of_vertex;
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) count_of_vertex.push_back(add_vertex(v));
    const std::vector<std::uint32_t> first = number_wedges(forest, count_of_vertex, hierarchy);
    for (std::size_t c = 0; c < found_.of_corner.size(); ++c) {  // so far counted at their vertex
      const std::size_t v = index_of(mesh_.triangles[c / 3][c % 3]);
      found_.of_corner[c] =
          WedgeId{first[v] + static_cast<std::uint32_t>(index_of(found_.of_corner[c]))};
    }
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) fill_layer(l, hierarchy.wedge_count());
    return std::move(found_);
  }

 private:
  void prepare() {
    found_.of_corner.resize(3 * mesh_.triangle_count());
    found_.layers.resize(mesh_.layers.size());
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      found_.layers[l].first_of_vertex.push_back(0);
      regions_.push_back(ordering_regions(mesh_, around_, mesh_.layers[l]));
      at_corner_.emplace_back(3 * mesh_.triangle_count());
    }
  }

  // Returns how many wedges it has.
  std::uint32_t add_vertex(std::size_t v) {
    const std::span<const std::uint32_t> corners = around_.of(v);
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      LeafAttributes& leaves = found_.layers[l];
      add_attributes(mesh_.layers[l], regions_[l], corners, leaves);
      place_of_id_.look_at(leaves, v);
      for (std::uint32_t c : corners) at_corner_[l][c] = place_of_id_[mesh_.layers[l].of_corner[c]];
    }
    sorted_.assign(corners.begin(), corners.end());
    const auto less = [this](std::uint32_t a, std::uint32_t b) {
      for (const std::vector<std::uint32_t>& at : at_corner_) {
        if (at[a] != at[b]) return at[a] < at[b];
      }
      return false;
    };
    std::stable_sort(sorted_.begin(), sorted_.end(), less);
    std::uint32_t wedge = 0;
    for (std::size_t i = 0; i < sorted_.size(); ++i) {
      if (i > 0 && less(sorted_[i - 1], sorted_[i])) ++wedge;
      found_.of_corner[sorted_[i]] = WedgeId{wedge};
    }
    return sorted_.empty() ? 0 : wedge + 1;
  }

  void fill_layer(std::size_t l, std::size_t wedge_count) {
    found_.layers[l].of_wedge.resize(wedge_count);
    for (std::size_t c = 0; c < found_.of_corner.size(); ++c) {
      found_.layers[l].of_wedge[index_of(found_.of_corner[c])] = at_corner_[l][c];
    }
    at_corner_[l] = {};
  }

  const Mesh& mesh_;
  const CornersAround around_;
  LeafWedges found_;
  std::vector<std::vector<std::uint32_t>> regions_;    // per layer and triangle
  std::vector<std::vector<std::uint32_t>> at_corner_;  // per layer and corner: its leaf attribute
  PlaceOfId place_of_id_;
  std::vector<std::uint32_t> sorted_;
};

}  // namespace

LeafWedges find_wedges(const Mesh& snapped, const VertexForest& forest,
                       VertexHierarchy& hierarchy) {
  return WedgeFinder(snapped).run(forest, hierarchy);
}

}  // namespace crease

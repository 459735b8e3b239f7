#include "crease/indexed_arrays.h"

#include "crease/block_mesh.h"

#include <cstddef>
#include <utility>

namespace crease {

namespace {

// `part`: of Indexer::parts_.
struct Source {
  std::uint32_t material, part, number;
};

class Indexer {
 public:
  explicit Indexer(const DrawList& list)
      : list_(list),
        parts_{&list.sn, &list.fn, &list.nsn},
        first_at_(list.positions.size(), kNone) {
    for (const DrawPart* part : parts_) {
      has_colors_ |= !part->colors.empty();
      has_texcoords_ |= !part->texcoords.empty();
      has_materials_ |= !part->materials.empty();
    }
    arrays_.origin = list.origin;
    arrays_.indices.reserve(list.sn.indices.size() + list.fn.indices.size() +
                            list.nsn.indices.size());
    arrays_.positions.reserve(list.positions.size());
    arrays_.normals.reserve(list.positions.size());
    next_.reserve(list.positions.size());
    arrays_.listed.reserve(arrays_.indices.capacity() / 3);
  }

  // Of the three parts.
  void add(const std::array<Range, 3>& ranges) {
    sources_.clear();
    for (std::uint32_t p = 0; p < 3; ++p) {
      for (std::uint32_t t = ranges[p].first; t < ranges[p].first + ranges[p].count; ++t) {
        const auto& materials = parts_[p]->materials;
        sources_.push_back({materials.empty() ? 0 : materials[t], p, t});
      }
    }
    if (has_materials_) sort_by_material();
    for (const Source& t : sources_) add(t);
  }

  IndexedArrays take() { return std::move(arrays_); }

 private:
  struct Corner {
    std::uint32_t position, material;
    Vec3f normal;
    std::array<float, 4> color{1, 1, 1, 1};
    std::array<float, 2> texcoord{};
  };

  Corner corner_of(const Source& t, std::size_t c) const {
    const DrawPart& part = *parts_[t.part];
    const std::size_t at = 3 * std::size_t(t.number) + c;
    Corner corner{.position = part.indices[at], .material = t.material, .normal = {}};
    const std::size_t kind = t.part;
    corner.normal = kind == 0   ? list_.vertex_normals[corner.position]
                    : kind == 1 ? part.normals[t.number]
                                : part.normals[at];
    if (!part.colors.empty()) corner.color = part.colors[at];
    if (!part.texcoords.empty()) corner.texcoord = part.texcoords[at];
    return corner;
  }

  void sort_by_material() {
    first_of_material_.clear();
    for (const Source& source : sources_) {
      if (source.material + 2 > first_of_material_.size()) {
        first_of_material_.resize(source.material + 2, 0);
      }
      ++first_of_material_[source.material + 1];
    }
    for (std::size_t m = 1; m < first_of_material_.size(); ++m) {
      first_of_material_[m] += first_of_material_[m - 1];
    }
    sorted_.resize(sources_.size());
    for (const Source& source : sources_) sorted_[first_of_material_[source.material]++] = source;
    sources_.swap(sorted_);
  }

  bool is_vertex(std::size_t v, const Corner& corner) const {
    return arrays_.normals[v] == corner.normal &&
           (!has_materials_ || arrays_.materials[v] == corner.material) &&
           (!has_colors_ || arrays_.colors[v] == corner.color) &&
           (!has_texcoords_ || arrays_.texcoords[v] == corner.texcoord);
  }

  // The vertices of one position are a list: few each.
  std::uint32_t vertex_of(const Corner& corner) {
    std::uint32_t v = first_at_[corner.position];
    while (v != kNone && !is_vertex(v, corner)) v = next_[v];
    if (v != kNone) return v;
    v = std::uint32_t(next_.size());
    next_.push_back(first_at_[corner.position]);
    first_at_[corner.position] = v;
    arrays_.positions.push_back(list_.positions[corner.position]);
    arrays_.normals.push_back(corner.normal);
    if (has_materials_) arrays_.materials.push_back(corner.material);
    if (has_colors_) arrays_.colors.push_back(corner.color);
    if (has_texcoords_) arrays_.texcoords.push_back(corner.texcoord);
    return v;
  }

  void add(const Source& t) {
    if (arrays_.runs.empty() || arrays_.runs.back().material != t.material) {
      const auto first = std::uint32_t(arrays_.triangle_count());
      arrays_.runs.push_back({t.material, {first, 0}});
    }
    ++arrays_.runs.back().triangles.count;
    arrays_.listed.push_back({TriangleKind(t.part), t.number});
    for (std::size_t c = 0; c < 3; ++c) arrays_.indices.push_back(vertex_of(corner_of(t, c)));
  }

  const DrawList& list_;
  std::array<const DrawPart*, 3> parts_;
  std::vector<std::uint32_t> first_at_, next_;
  std::vector<Source> sources_, sorted_;
  std::vector<std::size_t> first_of_material_;
  bool has_colors_ = false, has_texcoords_ = false, has_materials_ = false;
  IndexedArrays arrays_;
};

Range all_of(const DrawPart& part) {
  return {0, std::uint32_t(part.triangle_count())};
}

}  // namespace

IndexedArrays indexed_arrays(const DrawList& list) {
  Indexer indexer(list);
  indexer.add({all_of(list.sn), all_of(list.fn), all_of(list.nsn)});
  return indexer.take();
}

IndexedArrays indexed_arrays(const ResidentBlock& block) {
  const DrawList list = block.draw_list();
  Indexer indexer(list);
  for (const BlockGroup& group : block.groups()) indexer.add({group.sn, group.fn, group.nsn});
  return indexer.take();
}

// Groups before a run have all triangles that come before its own in the three parts.
Range triangles_of(const ShownRange& shown) {
  return {shown.sn.first + shown.fn.first + shown.nsn.first, std::uint32_t(shown.triangle_count())};
}

}  // namespace crease

#include "pipeline/plan_blocks.h"

#include "base/assert.h"
#include "codec/contracting_patch.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace crease {

namespace {

// The mesh as the bands leave it, one after the other.
class Planner {
 public:
  Planner(const Mesh& snapped, const ContractionSequence& sequence,
          std::span<const LayerCoding> codings)
      : mesh_(snapped), sequence_(sequence) {
    auto values = std::make_shared<std::vector<std::vector<codec::CodedValue>>>();
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      values->push_back(all_values(LayerValues(codings[l], mesh_.layers[l].dimension), l));
    }
    values_ = std::move(values);
    positions_.reserve(mesh_.positions.size());
    for (const Vec3d& p : mesh_.positions) positions_.push_back(sequence_.grid.nearest(p));
    corners_.reserve(mesh_.triangles.size());
    for (const Triangle& t : mesh_.triangles) {
      corners_.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                          static_cast<std::uint32_t>(t[2])});
    }
    for (const AttributeLayer& layer : mesh_.layers) of_corner_.push_back(layer.of_corner);
    is_alive_.assign(corners_.size(), 1);
    derived_.assign(corners_.size(), 0);
    label_.assign(corners_.size(), 0);
    slot_of_vertex_.assign(positions_.size(), kNone);
    error_.resize(positions_.size());
  }

  // The patches of the next band, at their fine ends; then its contractions.
  BandPlans plan_band(const Band& band) {
    BandPlans result;
    result.values = values_;
    result.plans.resize(band.patch_count());
    result.value_ids.resize(band.patch_count());
    result.vertex_ids.resize(band.patch_count());
    result.triangle_ids.resize(band.patch_count());
    result.errors.resize(band.patch_count());
    result.roots.resize(band.patch_count());
    std::vector<std::vector<std::size_t>> contractions(band.patch_count());
    for (std::uint32_t i = 0; i < band.contraction_count; ++i, ++next_) {
      contractions[sequence_.patch_of_contraction[next_]].push_back(next_);
    }
    for (std::uint32_t p = 0; p < band.patch_count(); ++p) {
      const auto triangles = band.triangles_of(p);
      result.triangle_ids[p].reserve(triangles.size());
      for (TriangleId t : triangles) {
        result.triangle_ids[p].push_back(static_cast<std::uint32_t>(t));
      }
      result.plans[p] =
          plan_patch(result.triangle_ids[p], result.vertex_ids[p], result.value_ids[p]);
      result.errors[p].fine = largest_error(result.vertex_ids[p]);
      contract(contractions[p], result.plans[p], result.triangle_ids[p], result.vertex_ids[p]);
      result.errors[p].coarse = largest_error(result.vertex_ids[p]);
      result.roots[p] = find_roots(result.plans[p], result.vertex_ids[p], result.triangle_ids[p]);
      for (std::uint32_t t : result.triangle_ids[p]) label_[t] = p;
    }
    return result;
  }

  // What is left when all bands are done.
  BandPlans plan_base() {
    BandPlans result;
    result.values = values_;
    result.triangle_ids.resize(1);
    result.vertex_ids.resize(1);
    result.value_ids.resize(1);
    for (std::uint32_t t = 0; t < corners_.size(); ++t) {
      if (is_alive_[t]) result.triangle_ids[0].push_back(t);
    }
    result.plans.push_back(
        plan_patch(result.triangle_ids[0], result.vertex_ids[0], result.value_ids[0]));
    const LevelError error = largest_error(result.vertex_ids[0]);
    result.errors.push_back({error, error});
    return result;
  }

 private:
  // Of all values at once: corners of every band have them.
  std::vector<codec::CodedValue> all_values(const LayerValues& values, std::size_t l) {
    const AttributeLayer& layer = mesh_.layers[l];
    const std::size_t dimension = static_cast<std::size_t>(layer.dimension);
    std::vector<codec::CodedValue> codes;
    const auto add = [&](std::span<const float> all) {
      for (std::size_t i = 0; dimension > 0 && i < all.size(); i += dimension) {
        codes.push_back(values.code(all.subspan(i, dimension)));
      }
    };
    add(layer.values);
    if (l < sequence_.new_values.size()) add(sequence_.new_values[l]);
    return codes;
  }

  codec::BlockPlan plan_patch(const std::vector<std::uint32_t>& triangles,
                              std::vector<std::uint32_t>& vertices,
                              std::vector<std::vector<AttributeId>>& values) {
    codec::BlockPlan plan;
    plan.fine.triangles.reserve(triangles.size());
    plan.fine.category.reserve(triangles.size());
    plan.fine.derived.reserve(triangles.size());
    plan.labels.reserve(triangles.size());
    values.resize(mesh_.layers.size());
    for (std::vector<AttributeId>& of_layer : values) of_layer.reserve(3 * triangles.size());
    for (const std::uint32_t t : triangles) {
      codec::Corners corners = corners_[t];
      for (std::uint32_t& v : corners) {
        std::uint32_t& slot = slot_of_vertex_[v];
        if (slot == kNone) {
          slot = static_cast<std::uint32_t>(vertices.size());
          vertices.push_back(v);
          plan.fine.positions.push_back(positions_[v]);
        }
        v = slot;
      }
      plan.fine.triangles.push_back(corners);
      plan.fine.category.push_back(category_of(t));
      plan.fine.derived.push_back(derived_[t]);
      plan.labels.push_back(label_[t]);
      for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
        for (std::size_t c = 0; c < 3; ++c) values[l].push_back(of_corner_[l][3 * t + c]);
      }
    }
    for (const std::uint32_t v : vertices) slot_of_vertex_[v] = kNone;
    vertices.shrink_to_fit();
    plan.fine.positions.shrink_to_fit();
    return plan;
  }

  // After its contractions.
  std::vector<std::uint32_t> find_roots(const codec::BlockPlan& plan,
                                        const std::vector<std::uint32_t>& vertices,
                                        const std::vector<std::uint32_t>& triangles) {
    std::vector<char> is_gone(vertices.size(), 0);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) slot_of_vertex_[vertices[i]] = i;
    for (const codec::BlockPlan::Step& step : plan.steps) is_gone[step.removed] = 1;
    for (const std::uint32_t t : triangles) {
      if (!is_alive_[t]) continue;
      for (const std::uint32_t v : corners_[t]) is_gone[slot_of_vertex_[v]] = 1;
    }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      slot_of_vertex_[vertices[i]] = kNone;
      if (!is_gone[i]) roots.push_back(vertices[i]);
    }
    return roots;
  }

  LevelError largest_error(const std::vector<std::uint32_t>& vertices) const {
    LevelError all;
    for (const std::uint32_t v : vertices) all = larger(all, error_[v]);
    return all;
  }

  // By the definition of crease/contraction.h, inside one patch.
  void contract(const std::vector<std::size_t>& contractions, codec::BlockPlan& plan,
                const std::vector<std::uint32_t>& triangles,
                const std::vector<std::uint32_t>& vertices) {
    for (std::uint32_t slot = 0; slot < vertices.size(); ++slot) {
      slot_of_vertex_[vertices[slot]] = slot;
    }
    codec::ContractingPatch patch(plan.fine);
    plan.steps.reserve(contractions.size());
    for (const std::size_t i : contractions) {
      const Contraction& c = sequence_.contractions[i];
      const std::uint32_t removed = static_cast<std::uint32_t>(c.removed);
      const std::uint32_t kept = static_cast<std::uint32_t>(c.kept);
      const std::uint32_t removed_slot = slot_of_vertex_[removed], slot = slot_of_vertex_[kept];
      for (const std::uint32_t t : patch.contract(slot, removed_slot)) is_alive_[triangles[t]] = 0;
      positions_[kept] = c.position;
      error_[kept] = c.error;
      for (TriangleId t : sequence_.derived_of(c)) derived_[index_of(t)] = 1;
      for (const AttributeChange& change : sequence_.changes_of(c)) {
        change_attribute(patch, slot, triangles, change);
      }
      plan.steps.push_back({removed_slot, slot, c.position});
    }
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) corners_[triangles[t]][k] = vertices[patch.corners(t)[k]];
    }
    for (const std::uint32_t v : vertices) slot_of_vertex_[v] = kNone;
  }

  void change_attribute(const codec::ContractingPatch& patch, std::uint32_t kept,
                        const std::vector<std::uint32_t>& triangles,
                        const AttributeChange& change) {
    const bool is_normal = mesh_.layers[change.layer].role == AttributeRole::Normal;
    for (const std::uint32_t t : patch.around(kept)) {
      const std::size_t of_model = triangles[t];
      if (is_normal && derived_[of_model]) continue;
      const std::uint32_t c = codec::corner_of(patch.corners(t), kept);
      AttributeId& attribute = of_corner_[change.layer][3 * of_model + c];
      if (attribute == change.from) attribute = change.to;
    }
  }

  std::uint32_t category_of(std::uint32_t t) const {
    const std::uint32_t materials =
        std::max<std::uint32_t>(1, static_cast<std::uint32_t>(mesh_.materials.size()));
    std::uint32_t category = 0;
    if (!mesh_.part_of_triangle.empty()) {
      category = static_cast<std::uint32_t>(mesh_.part_of_triangle[t]) * materials;
    }
    if (!mesh_.material_of_triangle.empty()) {
      category += static_cast<std::uint32_t>(mesh_.material_of_triangle[t]);
    }
    return category;
  }

  const Mesh& mesh_;
  const ContractionSequence& sequence_;
  std::shared_ptr<const std::vector<std::vector<codec::CodedValue>>> values_;  // per layer
  std::size_t next_ = 0;                                                       // in the sequence
  std::vector<Vec3i> positions_;                                               // per vertex
  std::vector<LevelError> error_;                                              // per vertex
  std::vector<codec::Corners> corners_;                                        // per triangle
  std::vector<std::vector<AttributeId>> of_corner_;  // per layer, 3 a triangle
  std::vector<char> is_alive_, derived_;             // per triangle
  std::vector<std::uint32_t> label_;                 // per triangle: its patch in the band before
  std::vector<std::uint32_t> slot_of_vertex_;        // all kNone between patches
};

AttributeCoding coding_of(LayerCoding::Kind kind) {
  switch (kind) {
    case LayerCoding::Kind::Exact:
      return AttributeCoding::Floats;
    case LayerCoding::Kind::Lattice:
      return AttributeCoding::Lattice;
    case LayerCoding::Kind::Octahedral:
      return AttributeCoding::Octahedral;
    case LayerCoding::Kind::Sextant:
      return AttributeCoding::Sextant;
  }
  return AttributeCoding::Floats;
}

}  // namespace

codec::BlockPlan BandPlans::plan(std::size_t p) const {
  codec::BlockPlan whole = plans[p];
  whole.fine.values.resize(value_ids[p].size());
  for (std::size_t l = 0; l < value_ids[p].size(); ++l) {
    whole.fine.values[l].reserve(value_ids[p][l].size());
    for (const AttributeId a : value_ids[p][l]) {
      whole.fine.values[l].push_back((*values)[l][index_of(a)]);
    }
  }
  return whole;
}

std::vector<LayerSchema> schema_of(const Mesh& mesh, std::span<const LayerCoding> codings) {
  std::vector<LayerSchema> layers;
  for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
    const AttributeLayer& layer = mesh.layers[l];
    layers.push_back({.name = layer.name,
                      .role = layer.role,
                      .interpolation = layer.interpolation,
                      .dimension = static_cast<std::uint8_t>(layer.dimension),
                      .coding = coding_of(codings[l].kind),
                      .bits = static_cast<std::uint8_t>(codings[l].bits)});
  }
  return layers;
}

codec::BlockCoding block_coding(const Mesh& mesh, std::span<const LayerCoding> codings) {
  return block_coding(schema_of(mesh, codings), codings, mesh.materials.size(), mesh.parts.size());
}

namespace {

// A vertex on the border of several patches all of whose triangles vanish within one band would be
// made by each of their blocks. The base makes it instead, and they name it.
void move_shared_roots(std::vector<BandPlans>& plans, std::size_t vertex_count) {
  std::vector<char> is_named(vertex_count, 0), is_root(vertex_count, 0);
  BandPlans& base = plans.front();
  for (const BandPlans& band : plans) {
    std::vector<std::uint32_t> seen;
    for (std::size_t p = 0; p < band.roots.size(); ++p) {
      for (const std::uint32_t v : band.roots[p]) {
        if (is_named[v]) continue;
        if (is_root[v]) {
          is_named[v] = 1;
          const auto& ids = band.vertex_ids[p];
          const auto at = std::find(ids.begin(), ids.end(), v) - ids.begin();
          base.vertex_ids[0].push_back(v);
          base.plans[0].fine.positions.push_back(
              band.plans[p].fine.positions[static_cast<std::size_t>(at)]);
        }
        is_root[v] = 1;
        seen.push_back(v);
      }
    }
    for (const std::uint32_t v : seen) is_root[v] = 0;
    for (const auto& ids : band.vertex_ids) {
      for (const std::uint32_t v : ids) is_named[v] = 1;
    }
  }
}

}  // namespace

std::vector<BandPlans> plan_blocks(const Mesh& snapped, const ContractionSequence& sequence,
                                   std::span<const LayerCoding> codings) {
  Planner planner(snapped, sequence, codings);
  std::vector<BandPlans> plans;
  for (const Band& band : sequence.bands) plans.push_back(planner.plan_band(band));
  plans.push_back(planner.plan_base());
  std::reverse(plans.begin(), plans.end());
  move_shared_roots(plans, snapped.vertex_count());
  return plans;
}

}  // namespace crease

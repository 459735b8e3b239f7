#include "assemble/restructure.h"

#include "assemble/replay.h"
#include "base/assert.h"

#include <algorithm>

namespace crease {

namespace {

bool has_one_value(const AttributeLayer& layer, std::size_t t) {
  const AttributeId* id = &layer.of_corner[3 * t];
  return id[0] == id[1] && id[1] == id[2];
}

ProgressiveLayer::Storage cheapest_storage(const Mesh& mesh, const AttributeLayer& layer,
                                           std::size_t explicit_count, bool faces_agree) {
  const std::size_t triangles = mesh.triangle_count();
  const std::size_t values = 4 * layer.values.size();
  const std::size_t rows = explicit_count == 0 ? 0 : 4 * triangles + 12 * explicit_count;
  const std::size_t as_vertex = 4 * layer.dimension * mesh.vertex_count() + rows;
  const std::size_t as_corner = values + 12 * triangles;
  const std::size_t as_face = values + 4 * triangles;
  if (as_vertex <= std::min(as_corner, faces_agree ? as_face : as_corner)) {
    return ProgressiveLayer::Storage::Vertex;
  }
  return faces_agree ? ProgressiveLayer::Storage::Face : ProgressiveLayer::Storage::Corner;
}

}  // namespace

Restructured restructure(const Mesh& snapped, const ContractionSequence& sequence) {
  Restructured result;
  std::vector<std::uint8_t> faces_agree;  // per layer
  std::vector<std::uint8_t> has_face_normal(snapped.triangle_count(), 0);
  CREASE_ASSERT(snapped.normals() != nullptr);
  for (std::size_t l = 0; l < snapped.layers.size(); ++l) {
    const AttributeLayer& layer = snapped.layers[l];
    Sharing& sharing = result.sharing.emplace_back(snapped, sequence, l);
    bool agree = true;
    for (std::size_t t = 0; t < snapped.triangle_count(); ++t) {
      const bool one = has_one_value(layer, t);
      agree = agree && one;
      if (layer.role == AttributeRole::Normal) has_face_normal[t] = one ? 1 : 0;
    }
    faces_agree.push_back(agree ? 1 : 0);
    if (layer.role == AttributeRole::Normal) {
      result.normal_layer = l;
      sharing.own_where_all_agree();
    } else {
      sharing.own_what_most_have();
    }
  }

  Replay replay(snapped, sequence);
  const auto contraction_count = static_cast<std::uint32_t>(sequence.contractions.size());
  for (std::uint32_t i = 0; i < contraction_count; ++i) {
    const Step& step = replay.look(i);
    const auto changes = sequence.changes_of(sequence.contractions[i]);
    const bool keep_p = result.sharing[result.normal_layer].prefers_p(step, changes);
    for (Sharing& sharing : result.sharing) sharing.contract(replay, step, keep_p, changes);
    result.lost_triangles.insert(result.lost_triangles.end(), step.lost.begin(), step.lost.end());
    replay.contract(i, keep_p,
                    [&](std::uint32_t layer, std::uint32_t corner, std::uint32_t, std::uint32_t) {
                      faces_agree[layer] = 0;
                      if (layer == result.normal_layer) has_face_normal[corner / 3] = 0;
                    });
  }

  const Sharing& normals = result.sharing[result.normal_layer];
  result.kind_of_triangle.reserve(snapped.triangle_count());
  for (std::size_t t = 0; t < snapped.triangle_count(); ++t) {
    result.kind_of_triangle.push_back(!normals.is_explicit(t)   ? TriangleKind::SN
                                      : has_face_normal[t] != 0 ? TriangleKind::FN
                                                                : TriangleKind::NSN);
  }
  for (std::size_t l = 0; l < snapped.layers.size(); ++l) {
    Sharing& sharing = result.sharing[l];
    result.storage.push_back(cheapest_storage(snapped, snapped.layers[l], sharing.explicit_count(),
                                              faces_agree[l] != 0));
    if (l == result.normal_layer) {
      sharing.own_what_is_used(false);
    } else if (result.storage[l] == ProgressiveLayer::Storage::Vertex) {
      sharing.own_what_is_used(true);
    } else {
      sharing.make_all_explicit();
    }
  }
  return result;
}

}  // namespace crease

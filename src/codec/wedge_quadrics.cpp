#include "codec/wedge_quadrics.h"

#include "base/wide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace crease::codec {

namespace {

using simplification::AttributeQuadric;
using simplification::Quadric;
using simplification::Row;

// As the simplifier has them.
constexpr double kNormalWeight = 0.9;
constexpr double kThin = 1e-4;
constexpr std::size_t kMostACorner = 4;  // wedges, of a block; honest ones have two

bool have_all(const std::uint32_t* wedges) {
  return wedges[0] != kNone && wedges[1] != kNone && wedges[2] != kNone;
}

bool is_float(double x) {
  return std::abs(x) <= double(std::numeric_limits<float>::max());
}

}  // namespace

WedgeQuadrics::WedgeQuadrics(const UnfoldedBlock& block, std::span<const LayerSchema> layers,
                             std::span<const LayerValues> values, const PatchGeometry& geometry,
                             std::span<const char> is_contracted)
    : layers_(layers.size()), has_several_(block.end.positions.size(), 0) {
  for (std::uint32_t t = 0; t < block.end.triangles.size(); ++t) {
    sizes_.add(0.5 * geometry.normal(t).size);
  }
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const LayerSchema& schema = layers[l];
    if (schema.interpolation == Interpolation::Categorical || schema.role == AttributeRole::Other) {
      continue;
    }
    Layer& layer = layers_[l];
    layer.dimension = schema.dimension;
    layer.role = schema.role;
    layer.is_direction = schema.interpolation == Interpolation::Direction;
    load_wedges(block, values[l], l, is_contracted, layer);
    load_quadrics(block.end, values[l], l, geometry, layer);
    set_scale(block, schema, geometry, layer);
  }
}

void WedgeQuadrics::load_wedges(const UnfoldedBlock& block, const LayerValues& values,
                                std::size_t l, std::span<const char> is_contracted, Layer& layer) {
  const bool is_normal = layer.role == AttributeRole::Normal;
  std::uint32_t quadric_count = 0;
  const std::vector<CodedValue>& codes = block.end.values[l];
  std::vector<std::uint32_t> first_of_vertex(block.end.positions.size(), kNone);
  std::vector<std::uint32_t> next;          // per wedge: another one at the vertex
  std::vector<std::uint32_t> first_corner;  // per wedge
  std::vector<char> has_too_many;           // per vertex; empty: none
  WedgeValues& all = layer.values;
  all.of_corner.assign(codes.size(), kNone);
  layer.coarse = block.coarse_values[l];
  for (std::uint32_t t = 0; t < block.end.triangles.size(); ++t) {
    if (is_normal && block.end.derived[t]) continue;
    const CodedValue* code = &codes[3 * std::size_t(t)];
    const bool is_constant = code[0] == code[1] && code[1] == code[2];
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t v = block.end.triangles[t][c];
      std::uint32_t& first = first_of_vertex[v];
      if (!has_too_many.empty() && has_too_many[v]) continue;
      std::uint32_t w = first;
      std::size_t tried = 0;
      while (w != kNone && codes[first_corner[w]] != code[c]) {
        w = next[w];
        ++tried;
      }
      if (w == kNone && tried == kMostWedges) {
        has_too_many.resize(first_of_vertex.size());
        has_too_many[v] = 1;
        continue;
      }
      if (w == kNone) {
        if (first != kNone) has_several_[v] = 1;
        w = static_cast<std::uint32_t>(next.size());
        next.push_back(std::exchange(first, w));
        first_corner.push_back(3 * t + c);
        layer.wedges.push_back({.quadric = is_contracted[v] ? quadric_count++ : kNone});
        values.read(code[c],
                    std::span(all.value.emplace_back()).first(std::size_t(layer.dimension)));
      }
      layer.wedges[w].is_pinned = layer.wedges[w].is_pinned || is_constant;
      all.of_corner[3 * std::size_t(t) + c] = w;
      const bool is_wanted =
          t < block.coarse_triangle_count() && !(is_normal && block.coarse_derived[t]);
      if (is_wanted && layer.wedges[w].wanted == kNone) layer.wedges[w].wanted = 3 * t + c;
    }
  }
  for (std::size_t t = 0; t < block.end.triangles.size() && !has_too_many.empty(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (has_too_many[block.end.triangles[t][c]]) all.of_corner[3 * t + c] = kNone;
    }
  }
  layer.wedge_of_corner = all.of_corner;
  layer.quadrics.resize(quadric_count);
  all.into.assign(layer.wedges.size(), kNone);
  all.is_known.assign(layer.wedges.size(), 1);
}

CREASE_WIDE void WedgeQuadrics::load_quadrics(const PatchMesh& mesh, const LayerValues& values,
                                              std::size_t l, const PatchGeometry& geometry,
                                              Layer& layer) {
  const auto quadric_of = [&](std::uint32_t wedge) {
    return wedge == kNone ? kNone : layer.wedges[wedge].quadric;
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t* w = &layer.values.of_corner[3 * std::size_t(t)];
    const ScaledNormal& n = geometry.normal(t);
    if (!(n.size > 0)) continue;
    const std::array quadrics{quadric_of(w[0]), quadric_of(w[1]), quadric_of(w[2])};
    if (quadrics == std::array{kNone, kNone, kNone}) continue;
    std::array<std::array<float, 4>, 3> value{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (w[c] != kNone) {
        value[c] = layer.values.value[w[c]];
      } else {
        values.read(mesh.values[l][3 * std::size_t(t) + c],
                    std::span(value[c]).first(std::size_t(layer.dimension)));
      }
    }
    const Vec3d& p = geometry.place(mesh.triangles[t][0]);
    const Vec3d e1 = geometry.place(mesh.triangles[t][1]) - p;
    const Vec3d e2 = geometry.place(mesh.triangles[t][2]) - p;
    const double area = 0.5 * n.size;
    // The second and the third corner's barycentric coordinates, as linear functions.
    const double longest = std::max(std::max(dot(e1, e1), dot(e2, e2)), dot(e2 - e1, e2 - e1));
    Row second{0, 0, 0, 1.0 / 3}, third = second;
    if (n.size >= kThin * longest) {
      const double inverse = 1 / n.size;
      const Vec3d toward1 = cross(e2, n.unit) * inverse, toward2 = cross(n.unit, e1) * inverse;
      second = Row{toward1.x, toward1.y, toward1.z, -dot(toward1, p)};
      third = Row{toward2.x, toward2.y, toward2.z, -dot(toward2, p)};
    }
    AttributeQuadric of_triangle;
    of_triangle.own.weight = area;
    for (std::size_t j = 0; j < std::size_t(layer.dimension); ++j) {
      const double from = double(value[0][j]);
      const Row f = second * (double(value[1][j]) - from) + third * (double(value[2][j]) - from) +
                    Row{0, 0, 0, from};
      of_triangle.own.add_square(f, area);
      of_triangle.linear[j] = f * area;
    }
    for (const std::uint32_t q : quadrics) {
      if (q != kNone) layer.quadrics[q].add(of_triangle, layer.dimension);
    }
  }
}

// What the simplifier takes for the whole model, for this block.
void WedgeQuadrics::set_scale(const UnfoldedBlock& block, const LayerSchema& schema,
                              const PatchGeometry& geometry, Layer& layer) const {
  TextureSize texture(sizes_.most());
  if (schema.role == AttributeRole::TexCoord && layer.dimension >= 2) {
    for (std::uint32_t t = 0; t < block.end.triangles.size(); ++t) {
      const std::uint32_t* w = &layer.values.of_corner[3 * std::size_t(t)];
      if (!have_all(w)) continue;
      const std::vector<std::array<float, 4>>& values = layer.values.value;
      texture.add(0.5 * geometry.normal(t).size, values[w[0]].data(), values[w[1]].data(),
                  values[w[2]].data());
    }
  }
  const double edge2 = 2.3 * sizes_.mean();
  if (schema.role == AttributeRole::Normal) {
    layer.scale = radian() * radian();
  } else if (texture.unit2() > 0) {
    layer.scale = 0.09 * texture.unit2();
    layer.values.same = same_texture(std::sqrt(edge2 / texture.unit2()));
  } else {
    layer.scale = 0.25 * kNormalWeight * kNormalWeight * edge2;
  }
}

double WedgeQuadrics::radian() const {
  return kNormalWeight * std::sqrt(2.3 * sizes_.mean());
}

double WedgeQuadrics::contract(const ContractingPatch& patch,
                               std::span<const std::uint32_t> vanished, std::uint32_t first,
                               std::uint32_t second, const Vec3d& at) {
  double cost = 0;
  degrees_ = texture_ = 0;
  displacement_ = 0;
  for (Layer& layer : layers_) {
    if (layer.wedges.empty()) continue;
    worst_square_ = 0;
    cost += contract(patch, vanished, first, second, at, layer);
    const double own = std::sqrt(worst_square_);
    if (layer.role == AttributeRole::Normal) {  // a chord on the unit sphere
      degrees_ = static_cast<float>(crease::degrees(2 * std::asin(std::min(1.0, own / 2))));
    } else if (layer.role == AttributeRole::TexCoord && is_float(own)) {
      texture_ = std::max(texture_, static_cast<float>(own));
    }
  }
  return cost;
}

// Two values that faces show do not become one, nor do two that the coarse end has.
bool WedgeQuadrics::keep_apart(const Layer& layer, std::uint32_t a, std::uint32_t b) const {
  const std::uint32_t of_a = layer.wedges[a].wanted, of_b = layer.wedges[b].wanted;
  if (of_a != kNone && of_b != kNone && layer.coarse[of_a] != layer.coarse[of_b]) return true;
  return layer.wedges[a].is_pinned && layer.wedges[b].is_pinned &&
         layer.values.value[a] != layer.values.value[b];
}

double WedgeQuadrics::contract(const ContractingPatch& patch,
                               std::span<const std::uint32_t> vanished, std::uint32_t first,
                               std::uint32_t second, const Vec3d& at, Layer& layer) {
  members_.clear();
  root_.clear();
  const auto place_of = [&](std::uint32_t wedge) {
    std::uint32_t& place = layer.wedges[wedge].place;
    if (place >= members_.size() || members_[place] != wedge) {
      place = static_cast<std::uint32_t>(members_.size());
      members_.push_back(wedge);
      root_.push_back(place);
    }
    return place;
  };
  const auto corner_at = [&](std::uint32_t t, std::uint32_t v) {
    return 3 * std::size_t(t) + corner_of(patch.corners(t), v);
  };
  std::uint32_t last = kNone;  // mostly the next one has it too
  for (const std::uint32_t t : patch.around(first)) {
    const std::uint32_t wedge = layer.wedge_of_corner[corner_at(t, first)];
    if (wedge != last && wedge != kNone) place_of(wedge);
    last = wedge;
  }
  if (members_.size() > kMostWedges ||
      layer.wedges.size() + members_.size() > kMostACorner * layer.wedge_of_corner.size()) {
    forget(patch, first, layer);
    return 0;
  }
  for (const std::uint32_t t : vanished) {
    const std::uint32_t wa = layer.wedge_of_corner[corner_at(t, first)];
    const std::uint32_t wb = layer.wedge_of_corner[corner_at(t, second)];
    if (wa == kNone || wb == kNone) continue;
    const std::uint32_t a = root_[place_of(wa)], b = root_[place_of(wb)];
    if (a == b) continue;
    bool is_kept_apart = false;
    for (std::size_t i = 0; i < members_.size() && !is_kept_apart; ++i) {
      for (std::size_t k = 0; k < members_.size() && root_[i] == a; ++k) {
        is_kept_apart =
            is_kept_apart || (root_[k] == b && keep_apart(layer, members_[i], members_[k]));
      }
    }
    if (is_kept_apart) continue;
    for (std::uint32_t& root : root_) {
      if (root == std::max(a, b)) root = std::min(a, b);
    }
  }
  double cost = 0;
  for (std::uint32_t i = 0; i < members_.size(); ++i) {
    if (root_[i] != i) continue;
    group_.clear();
    for (std::size_t k = i; k < members_.size(); ++k) {
      if (root_[k] == i) group_.push_back(members_[k]);
    }
    cost += join(group_, at, layer);
  }
  for (const std::uint32_t t : patch.around(first)) {
    std::uint32_t& wedge = layer.wedge_of_corner[corner_at(t, first)];
    if (wedge != kNone) wedge = layer.values.into[wedge];
  }
  return cost;
}

void WedgeQuadrics::forget(const ContractingPatch& patch, std::uint32_t first, Layer& layer) const {
  for (const std::uint32_t member : members_) layer.values.into[member] = kNone;
  for (const std::uint32_t t : patch.around(first)) {
    layer.wedge_of_corner[3 * std::size_t(t) + corner_of(patch.corners(t), first)] = kNone;
  }
}

CREASE_WIDE double WedgeQuadrics::join(std::span<const std::uint32_t> members, const Vec3d& at,
                                       Layer& layer) {
  WedgeValues& all = layer.values;
  const auto made = static_cast<std::uint32_t>(layer.wedges.size());
  Wedge wedge{.quadric = layer.wedges[members[0]].quadric};
  AttributeQuadric& sum = layer.quadrics[wedge.quadric];
  std::array<float, 4> value = all.value[members[0]];
  bool is_known = false;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Wedge& member = layer.wedges[members[i]];
    if (i > 0) sum.add(layer.quadrics[member.quadric], layer.dimension);
    if (wedge.wanted == kNone) wedge.wanted = member.wanted;
    if (member.is_pinned) {
      wedge.is_pinned = is_known = true;
      value = all.value[members[i]];
    }
    all.into[members[i]] = made;
  }
  double cost = 0;
  if (wedge.is_pinned) {
    cost = sum.at(at, layer.dimension, value.data());
  } else if (sum.own.weight > 0) {
    Quadric reduced;
    sum.add_reduced(reduced, layer.dimension, 1);
    cost = reduced.at(at);
    double best[4] = {}, norm2 = 0;
    is_known = true;
    for (int j = 0; j < layer.dimension; ++j) {
      best[j] = sum.weighted_value(j, at) / sum.own.weight;
      norm2 += best[j] * best[j];
      is_known = is_known && is_float(best[j]);
    }
    // Opposite directions have no middle.
    is_known = is_known && (!layer.is_direction || norm2 > 1e-4);
    const double size = layer.is_direction ? std::sqrt(norm2) : 1;
    for (std::size_t j = 0; j < 4 && is_known; ++j) value[j] = static_cast<float>(best[j] / size);
  }
  if (sum.own.weight > 0) {
    const double square = wedge.is_pinned ? cost : sum.at(at, layer.dimension, value.data());
    if (square / sum.own.weight > worst_square_) worst_square_ = square / sum.own.weight;
    if (is_float(square)) {
      displacement_ = std::max(displacement_, sum.displacement(square, layer.role));
    }
  }
  layer.wedges.push_back(wedge);
  all.into.push_back(kNone);
  all.value.push_back(value);
  all.is_known.push_back(is_known);
  return layer.scale * cost;
}

std::vector<WedgeValues> WedgeQuadrics::take() && {
  std::vector<WedgeValues> all;
  for (Layer& layer : layers_) all.push_back(std::move(layer.values));
  return all;
}

}  // namespace crease::codec

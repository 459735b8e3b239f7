// The roots and the splits of a block; included by block_coder.h.
#pragma once

#include "codec/block_coder.h"
#include "codec/mixed_bit.h"

#include <cmath>
#include <limits>

namespace crease::codec {

template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::code_roots() {
  if (mesh_.positions.size() > limits_.vertices || coarse_triangles_ > limits_.triangles) {
    return false;
  }
  std::uint32_t roots = 0, triangles = 0;
  if constexpr (Coder::kEncodes) {
    roots = static_cast<std::uint32_t>(guide_.roots().size());
    triangles = static_cast<std::uint32_t>(guide_.root_triangles().size());
  }
  roots = code_magnitude(coder_, root_count_, roots);
  triangles = code_magnitude(coder_, root_triangle_count_, triangles);
  if (roots > limits_.vertices - coarse_vertices_) return false;
  if (triangles > limits_.triangles - coarse_triangles_) return false;
  Vec3i last = mesh_.positions.empty() ? Vec3i{} : mesh_.positions[0];
  for (std::uint32_t i = 0; i < roots; ++i) {
    Vec3i position{};
    if constexpr (Coder::kEncodes) position = guide_.roots()[i];
    for (int k = 0; k < 3; ++k) {
      const std::int32_t step = wrapped_difference(position[k], last[k]);
      last[k] = wrapped_sum(last[k], code_signed(coder_, root_position_[std::size_t(k)], step));
    }
    VertexName name{kNone, 0};
    if constexpr (Coder::kEncodes) name = guide_.root_names()[i];
    if (coder_.bit(is_named_, name.block != kNone)) {
      name.block = code_magnitude(coder_, root_block_, name.block);
      name.vertex = code_magnitude(coder_, root_vertex_, name.vertex);
    }
    if (coder_.failed()) return false;
    root_names_.push_back(name);
    add_vertex(last);
  }
  const std::uint32_t vertices = static_cast<std::uint32_t>(mesh_.positions.size());
  for (std::uint32_t i = 0; i < triangles; ++i) {
    Corners corners{};
    if constexpr (Coder::kEncodes) corners = guide_.root_triangles()[i];
    for (std::uint32_t& v : corners) v = code_below(vertices, v);
    if (corrupt_ || corners[0] == corners[1] || corners[1] == corners[2] ||
        corners[2] == corners[0]) {
      return false;
    }
    add_triangle(corners);
  }
  return true;
}

// Breadth first: every vertex is asked once, and its children again.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::code_splits() {
  generation_.assign(mesh_.positions.size(), 0);
  ring_kind_.assign(mesh_.positions.size(), RingKind::Unknown);
  has_moved_.assign(mesh_.positions.size(), 0);
  for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) origin_.push_back(v);
  miss_.assign(mesh_.positions.size(), FourFloats{});
  double sum = 0;
  for (const Corners& t : mesh_.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3i &p = mesh_.positions[t[c]], &q = mesh_.positions[t[(c + 1) % 3]];
      sum +=
          std::abs(double(p.x) - q.x) + std::abs(double(p.y) - q.y) + std::abs(double(p.z) - q.z);
    }
  }
  mean_size_ =
      mesh_.triangles.empty() ? 0 : static_cast<float>(sum / (3 * double(mesh_.triangles.size())));
  std::vector<std::uint32_t> queue(mesh_.positions.size());
  for (std::uint32_t v = 0; v < queue.size(); ++v) queue[v] = v;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const std::uint32_t v = queue[i];
    const bool fan = look_around(v);
    if (fan && ring_.triangles.data() != around_[v].data()) {
      around_.reorder(v, ring_.triangles);
      ring_.triangles = around_[v];
    }
    if (fan) ring_kind_[v] = ring_.closed ? RingKind::Closed : RingKind::Open;
    bool splits = false;
    if constexpr (Coder::kEncodes) splits = guide_.is_split(v);
    coder_.enter(Stream::Flags);
    if (!code_flag(v, fan, splits)) continue;
    if (!split(v, fan)) return false;
    queue.push_back(v);
    queue.push_back(static_cast<std::uint32_t>(mesh_.positions.size() - 1));
  }
  return true;
}

// Whether the triangles at v are one fan: ring_, then.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::look_around(std::uint32_t v) {
  if (ring_kind_[v] == RingKind::Unknown) return find_ring(mesh_.triangles, around_[v], v, ring_);
  fill_ring(mesh_.triangles, around_[v], v, ring_kind_[v], ring_);
  return true;
}

// Leaves in places_ where the vertices of a fan are.
template <class Coder, class Guide>
typename BlockCoder<Coder, Guide>::Beside BlockCoder<Coder, Guide>::look_beside(std::uint32_t v,
                                                                                bool fan) {
  Beside beside;
  const Vec3i center = mesh_.positions[v];
  if (fan) {
    beside.count = static_cast<std::uint32_t>(ring_.vertices.size());
    for (std::size_t i = 0; i < ring_.vertices.size(); ++i) {
      const std::uint32_t w = ring_.vertices[i];
      places_[i] = seen_from(center, mesh_.positions[w]);
      beside.sizes += size_of_each(places_[i]);
      beside.split += generation_[w] > 0;
    }
    return beside;
  }
  const std::size_t count = std::min(around_[v].size(), kLargestRing);
  for (const std::uint32_t t : around_[v].first(count)) {
    for (const std::uint32_t w : mesh_.triangles[t]) {
      if (w == v) continue;
      beside.sizes += size_of_each(seen_from(center, mesh_.positions[w]));
      beside.split += generation_[w] > 0;
      ++beside.count;
    }
  }
  return beside;
}

// Whether v is split. What tells: how often those above it were, how large its triangles are beside
// those of the coarse end, how many they are, and whether those around it are split already.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::code_flag(std::uint32_t v, bool fan, bool splits) {
  const std::size_t kind = !fan ? 0 : ring_.closed ? 1 : 2;
  const std::size_t generation = std::min<std::size_t>(generation_[v], kGenerations - 1);
  const Beside beside = look_beside(v, fan);
  std::size_t size_class = 0, around_class = 0;
  if (beside.count > 0) {
    // Each 1.25 times the one before; what is infinite, or 0 times that, is not exceeded.
    constexpr float kNoLimit = std::numeric_limits<float>::infinity();
    constexpr FourFloats kLimits[] = {{0.35f, 0.4375f, 0.546875f, 0.68359375f},
                                      {0.8544921875f, 1.068115234375f, 1.33514404f, 1.66893005f},
                                      {2.08616257f, 2.60770321f, 3.25962901f, kNoLimit}};
    const float count = static_cast<float>(beside.count), size = sum_of_three(beside.sizes);
    const float mean = mean_size_ * count;
    FourInts above{};
    for (const FourFloats& limits : kLimits) above -= FourFloats{} + size > limits * mean;
    size_class = static_cast<std::size_t>((above[0] + above[1]) + (above[2] + above[3]));
    around_class = 1 + static_cast<std::size_t>(3.99f * static_cast<float>(beside.split) / count);
  }
  const std::size_t valence = std::min<std::size_t>(around_[v].size(), kValences - 1);
  MixedBit<4> bit({&flag_models_.by_size[generation][kind][size_class],
                   &flag_models_.by_valence[generation][kind][valence],
                   &flag_models_.by_neighbours[generation][around_class][size_class],
                   &flag_models_.by_kind[generation][kind]},
                  flag_weights_[std::min<std::size_t>(generation, 2)]);
  return coder_.bit(bit, splits);
}

template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::split(std::uint32_t v, bool fan) {
  if (mesh_.positions.size() >= limits_.vertices) return false;
  const Vec3i s = mesh_.positions[v];
  coder_.enter(Stream::Shapes);
  code_shape(v, fan);
  if (coder_.failed() || corrupt_) return false;
  if (shape_.introduced.size() > limits_.triangles - mesh_.triangles.size()) return false;
  const std::uint32_t u = add_vertex(s);
  generation_[v] = static_cast<std::uint8_t>(std::min(generation_[v] + 1, 255));
  generation_.push_back(generation_[v]);
  ring_kind_.push_back(RingKind::Unknown);
  miss_.push_back(miss_[v]);
  origin_.push_back(origin_[v]);
  has_moved_.push_back(has_moved_[v]);
  splits_.push_back({v, static_cast<std::uint32_t>(mesh_.triangles.size()),
                     static_cast<std::uint32_t>(shape_.introduced.size()), s});
  if (is_one_of_fan_) {
    apply_fan(v, u);
  } else {
    apply(v, u);
  }
  coder_.enter(Stream::Positions);
  code_positions(v, u, s);
  if constexpr (Coder::kEncodes) guide_.did_split(v, u, shape_.introduced);
  return true;
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_shape(std::uint32_t v, bool fan) {
  shape_.introduced.clear();
  is_one_of_fan_ = is_closed_fan_ = false;
  shape_.triangles.assign(around_[v].begin(), around_[v].end());
  shape_.to_second.assign(shape_.triangles.size(), 0);
  if constexpr (Coder::kEncodes) ask_shape(v);
  if (fan) {
    Fan found;
    bool is_fan = false;
    if constexpr (Coder::kEncodes) {
      // Which child comes first is free; in a fan it is the one outside.
      is_fan = find_fan(found);
      if (!is_fan) {
        guide_.name_children(true);
        ask_shape(v);
        is_fan = find_fan(found);
      }
    }
    if (coder_.bit(is_fan_[ring_.closed], is_fan)) {
      code_fan(found);
      is_one_of_fan_ = true;
      is_closed_fan_ = ring_.closed;
      return;
    }
  }
  code_general(v);
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::ask_shape(std::uint32_t v) {
  for (std::size_t i = 0; i < shape_.triangles.size(); ++i) {
    shape_.to_second[i] = guide_.goes_to_second(v, shape_.triangles[i]);
  }
  guide_.introduced(v, shape_.introduced);
}

// The encoder's shape as a fan, if it is one.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::find_fan(Fan& fan) {
  Shape& wanted = wanted_shape_;
  wanted = shape_;
  const std::vector<Introduced>& b = wanted.introduced;
  if (b.empty() || b.size() > 2 || (ring_.closed && b.size() != 2)) return false;
  const auto at = [&](std::uint32_t third) {
    const auto found = std::find(ring_.vertices.begin(), ring_.vertices.end(), third);
    return static_cast<std::uint32_t>(found - ring_.vertices.begin());
  };
  const std::uint32_t i = at(b.front().third), j = at(b.back().third);
  if (std::max(i, j) >= ring_.vertices.size() || (b.size() == 2 && i == j)) return false;
  fan = {b.size() == 1 ? 0 : std::min(i, j), std::max(i, j), b.size() == 1};
  make_fan(fan);
  const auto same = [](const Introduced& x, const Introduced& y) {
    return x.third == y.third && x.first_leads == y.first_leads;
  };
  const std::vector<Introduced>& a = shape_.introduced;
  if (shape_.to_second == wanted.to_second &&
      ((same(a.front(), b.front()) && same(a.back(), b.back())) ||
       (same(a.front(), b.back()) && same(a.back(), b.front())))) {
    return true;
  }
  shape_ = wanted;
  return false;
}

// Triangles [first, last) of the ring go to the second child. One new triangle stands at the vertex
// `last`, and one at `first` unless single.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::make_fan(const Fan& fan) {
  for (std::size_t i = 0; i < shape_.to_second.size(); ++i) {
    shape_.to_second[i] = i >= fan.first && i < fan.last;
  }
  shape_.introduced.clear();
  shape_.introduced.push_back({ring_.vertices[fan.last], true});
  if (!fan.single) shape_.introduced.push_back({ring_.vertices[fan.first], false});
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_fan(Fan fan) {
  const std::uint32_t vertices = static_cast<std::uint32_t>(ring_.vertices.size());
  fan.single = !ring_.closed && coder_.bit(is_single_, fan.single);
  if (ring_.closed && vertices <= PairOdds::kMost) {
    fan = code_likely_fan(fan);
  } else if (fan.single) {
    fan.first = 0;
    fan.last = code_below(vertices, fan.last);
  } else {
    fan.first = code_below(vertices - 1, fan.first);
    fan.last = fan.first + 1 + code_below(vertices - 1 - fan.first, fan.last - fan.first - 1);
  }
  make_fan(fan);
  fan_ = fan;
}

template <class Coder, class Guide>
typename BlockCoder<Coder, Guide>::Fan BlockCoder<Coder, Guide>::code_likely_fan(Fan fan) {
  const std::size_t count = ring_.vertices.size();
  ranked_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t w = ring_.vertices[i];
    ranked_[i] = {around_[w].size(), generation_[w] > 0};
  }
  pair_odds_.rate(std::span(places_).first(count), ranked_);
  const PairOdds::Pair pair = pair_odds_.code(coder_, {fan.first, fan.last});
  pair_odds_.learn(pair);
  return {pair.first, pair.last};
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_general(std::uint32_t v) {
  ring_vertices_.clear();
  ring_of_vertex_.resize(mesh_.positions.size(), 0);
  rank_of_vertex_.resize(mesh_.positions.size(), 0);
  ++ring_count_;
  for (std::uint32_t t : shape_.triangles) {
    for (std::uint32_t w : mesh_.triangles[t]) {
      if (w == v || ring_of_vertex_[w] == ring_count_) continue;
      ring_of_vertex_[w] = ring_count_;
      rank_of_vertex_[w] = static_cast<std::uint32_t>(ring_vertices_.size());
      ring_vertices_.push_back(w);
      if (ring_vertices_.size() > kLargestRing) break;
    }
  }
  const std::uint32_t near = static_cast<std::uint32_t>(ring_vertices_.size());
  const std::uint32_t all = static_cast<std::uint32_t>(mesh_.positions.size());
  const std::uint32_t count = code_magnitude(coder_, introduced_count_,
                                             static_cast<std::uint32_t>(shape_.introduced.size()));
  if (count > limits_.triangles - mesh_.triangles.size()) {
    corrupt_ = true;
    return;
  }
  shape_.introduced.resize(count);
  for (Introduced& introduced : shape_.introduced) {
    std::uint32_t rank = 0;
    if constexpr (Coder::kEncodes) {
      const std::uint32_t third = introduced.third;
      rank = ring_of_vertex_[third] == ring_count_ ? rank_of_vertex_[third] : near;
    }
    if (near > 0 && coder_.bit(is_in_ring_, rank < near)) {
      introduced.third = ring_vertices_[code_below(near, rank)];
    } else {
      introduced.third = code_below(all, introduced.third);
      if (introduced.third == v) corrupt_ = true;
    }
    introduced.first_leads = coder_.bit(first_leads_, introduced.first_leads);
    if (coder_.failed() || corrupt_) return;
  }
  // A triangle mostly goes where its neighbour went.
  for (std::size_t i = 0; i < shape_.triangles.size(); ++i) {
    const std::size_t context = i == 0 ? 2 : std::size_t(shape_.to_second[i - 1]);
    shape_.to_second[i] = coder_.bit(to_second_[context], shape_.to_second[i]);
  }
}

// A split of the fan: lists that are in order stay so.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::apply_fan(std::uint32_t v, std::uint32_t u) {
  const std::uint32_t at_last = static_cast<std::uint32_t>(mesh_.triangles.size());
  const std::uint32_t at_first = at_last + 1;  // unless single
  const std::span<const std::uint32_t> triangles = shape_.triangles;
  const std::size_t moved = fan_.last - fan_.first, added = fan_.single ? 1 : 2;
  std::uint32_t* stay = around_.replace(v, fan_.first, fan_.last, added);
  if (!fan_.single) *stay++ = at_first;
  *stay = at_last;
  std::uint32_t* go = around_.replace(u, 0, 0, moved + added);
  for (std::size_t i = fan_.first; i < fan_.last; ++i) {
    mesh_.triangles[triangles[i]][corner_of(mesh_.triangles[triangles[i]], v)] = u;
    *go++ = triangles[i];
  }
  *go++ = at_last;
  if (!fan_.single) *go = at_first;
  ring_kind_[u] = fan_.single ? RingKind::Open : RingKind::Closed;
  for (const std::uint32_t child : {v, u}) forget_ring_if_large(child);
  const std::uint32_t w_last = ring_.vertices[fan_.last], w_first = ring_.vertices[fan_.first];
  if (fan_.last > 0) {
    add_beside(w_last, triangles[fan_.last - 1], 0, at_last);
  } else {
    add_beside(w_last, triangles[0], 1, at_last);
  }
  mesh_.triangles.push_back({v, u, w_last});
  if (fan_.single) return;
  add_beside(w_first, triangles[fan_.first], 1, at_first);
  mesh_.triangles.push_back({u, v, w_first});
}

// Before a triangle at v, or `after` it; at the end of a list that is long.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::add_beside(std::uint32_t v, std::uint32_t neighbour,
                                          std::size_t after, std::uint32_t triangle) {
  const std::span<const std::uint32_t> list = around_[v];
  if (list.size() > kLargestRing) return around_.add(v, triangle);
  const auto found = std::find(list.begin(), list.end(), neighbour);
  around_.insert(v, std::size_t(found - list.begin()) + after, triangle);
  forget_ring_if_large(v);
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::forget_ring_if_large(std::uint32_t v) {
  if (around_[v].size() > kLargestRing) ring_kind_[v] = RingKind::Unknown;
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::apply(std::uint32_t v, std::uint32_t u) {
  around_.clear(v);
  for (std::size_t i = 0; i < shape_.triangles.size(); ++i) {
    const std::uint32_t t = shape_.triangles[i];
    for (const std::uint32_t w : mesh_.triangles[t]) ring_kind_[w] = RingKind::Unknown;
    if (shape_.to_second[i]) {
      mesh_.triangles[t][corner_of(mesh_.triangles[t], v)] = u;
      around_.add(u, t);
    } else {
      around_.add(v, t);
    }
  }
  for (const Introduced& introduced : shape_.introduced) {
    ring_kind_[introduced.third] = RingKind::Unknown;
    add_triangle(introduced.first_leads ? Corners{v, u, introduced.third}
                                        : Corners{u, v, introduced.third});
  }
}

}  // namespace crease::codec

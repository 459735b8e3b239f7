// docs/format-block.md, "Splits".
#include "plain_decoder/block_decoder.h"

#include <deque>

namespace plain {

namespace {

struct NewTriangle {
  std::uint32_t third = 0;
  bool first_leads = false;  // (v, u, third), else (u, v, third)
};

struct Shape {
  Numbers triangles;       // at v, in the order in which they are taken
  std::vector<bool> goes;  // per triangle: to u
  std::vector<NewTriangle> added;
  std::optional<Fan> fan;    // that was split as one
  std::size_t i = 0, j = 0;  // of a fan
};

class SplitReader {
 public:
  SplitReader(RangeDecoder& in, BlockState& block)
      : in_(in), block_(block), surface_(block.surface) {}

  void read();

 private:
  float mean_size() const;
  bool read_flag(std::uint32_t v, const std::optional<Fan>& fan);
  void split(std::uint32_t v, const std::optional<Fan>& fan);
  Shape read_shape(std::uint32_t v, const std::optional<Fan>& fan);
  void read_fan(std::uint32_t v, const Fan& fan, Shape& shape);
  PairOdds::Pair read_pair(std::uint32_t v, const Fan& fan);
  void read_general(std::uint32_t v, Shape& shape);
  void apply(std::uint32_t v, std::uint32_t u, const Shape& shape);
  void apply_fan(std::uint32_t v, std::uint32_t u, const Shape& shape);
  void put_beside(std::uint32_t w, std::uint32_t t, std::uint32_t beside, bool after);
  void read_positions(std::uint32_t v, std::uint32_t u, const Point& s, const Shape& shape);
  bool read_stays(std::size_t question, const Surroundings& around, std::uint32_t v,
                  std::uint32_t u);
  Miss expected_miss(std::uint32_t v, const Surroundings& around) const;
  Child child(bool second, Who who, std::uint32_t v, const Point& s, const Point& sibling,
              const Shape& shape) const;
  std::vector<Along> vertices_around(std::uint32_t v, const Point& s, const Point& at_u,
                                     const std::array<std::size_t, 3>& axis) const;
  Point read_place(std::uint32_t v, const Point& s, const Point& at_u, const Surroundings& around,
                   const Child& child);
  void read_between(std::uint32_t v, std::uint32_t u, const Point& s, const Surroundings& around,
                    const Shape& shape, Point& at_v, Point& at_u);

  RangeDecoder& in_;
  BlockState& block_;
  Surface& surface_;
  float mean_size_ = 0;

  BitsBy<3> flag_by_size_, flag_by_triangles_, flag_by_neighbours_;
  BitsBy<2> flag_by_kind_;
  std::array<Weights, 3> flag_weights_;
  BitsBy<1> is_fan_;
  AdaptiveBit is_single_;
  PairOdds pair_odds_;
  Magnitude added_count_;
  AdaptiveBit is_in_ring_, first_leads_;
  BitsBy<1> goes_;
  struct StaysModels {
    BitsBy<1> by_share;
    BitsBy<2> by_triangles, by_both;
    Weights weights;
  };
  std::array<StaysModels, 3> stays_;
  BetweenModel between_;
  SeenModels seen_;
  PlaceModel model_of(Who who) const { return {who, block_.schema.rates}; }
  std::array<PlaceModel, 5> places_{model_of(Who::One), model_of(Who::SecondOfBoth),
                                    model_of(Who::FirstOfBoth), model_of(Who::SecondBetween),
                                    model_of(Who::FirstBetween)};
};

void SplitReader::read() {
  block_.vertices.assign(surface_.places.size(), {});
  std::deque<std::uint32_t> queue;
  for (std::uint32_t v = 0; v < surface_.places.size(); ++v) {
    block_.vertices[v].origin = v;
    queue.push_back(v);
  }
  mean_size_ = mean_size();
  while (!queue.empty()) {
    const std::uint32_t v = queue.front();
    queue.pop_front();
    const std::optional<Fan> fan = surface_.fan(v);
    if (fan) surface_.triangles_around[v] = fan->triangles;
    if (!read_flag(v, fan)) continue;
    split(v, fan);
    queue.push_back(v);
    queue.push_back(block_.splits.back().second);
  }
}

float SplitReader::mean_size() const {
  if (surface_.triangles.empty()) return 0;
  double sum = 0;
  for (const Triangle& t : surface_.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum += length_1(difference(surface_.places[t[(c + 1) % 3]], surface_.places[t[c]]));
    }
  }
  return static_cast<float>(sum / (3 * double(surface_.triangles.size())));
}

// Flag.
bool SplitReader::read_flag(std::uint32_t v, const std::optional<Fan>& fan) {
  Numbers beside;
  if (fan) {
    beside = fan->w;
  } else {
    for (const std::uint32_t t : surface_.first_of_list(v)) {
      for (const std::uint32_t w : surface_.triangles[t]) {
        if (w != v) beside.push_back(w);
      }
    }
  }
  FloatVector sizes;
  float split = 0;
  for (const std::uint32_t w : beside) {
    sizes = sizes + sizes_of(step(surface_.places[w], surface_.places[v]));
    if (block_.vertices[w].generation > 0) split += 1;
  }
  const std::size_t g = std::min<std::size_t>(block_.vertices[v].generation, 5);
  const std::size_t k = !fan ? 0 : fan->closed ? 1 : 2;
  const std::size_t n = std::min<std::size_t>(surface_.list(v).size(), 11);
  std::size_t c = 0, a = 0;
  if (!beside.empty()) {
    const float count = float(beside.size());
    double power = 1;
    for (; c < 11 && length_1(sizes) > float(0.35 * power) * (mean_size_ * count); ++c) {
      power *= 1.25;
    }
    a = 1 + static_cast<std::size_t>(3.99f * split / count);
  }
  return read_mixed(in_,
                    {&flag_by_size_[{g, k, c}], &flag_by_triangles_[{g, k, n}],
                     &flag_by_neighbours_[{g, a, c}], &flag_by_kind_[{g, k}]},
                    flag_weights_[std::min<std::size_t>(g, 2)]);
}

void SplitReader::split(std::uint32_t v, const std::optional<Fan>& fan) {
  demand(surface_.places.size() < block_.limits.vertices, "more vertices than there are");
  const Point s = surface_.places[v];
  const Shape shape = read_shape(v, fan);
  demand(shape.added.size() <= block_.limits.triangles - surface_.triangles.size(),
         "more triangles than there are");
  VertexState& state = block_.vertices[v];
  ++state.generation;
  block_.vertices.push_back(VertexState(state));
  const std::uint32_t u = surface_.add_vertex(s);
  block_.splits.push_back({v, u, static_cast<std::uint32_t>(surface_.triangles.size()),
                           static_cast<std::uint32_t>(shape.added.size()), s});
  apply(v, u, shape);
  read_positions(v, u, s, shape);
}

// Shape.
Shape SplitReader::read_shape(std::uint32_t v, const std::optional<Fan>& fan) {
  Shape shape;
  shape.triangles = fan ? fan->triangles : surface_.list(v);
  if (fan && is_fan_[{fan->closed}].read(in_)) {
    read_fan(v, *fan, shape);
  } else {
    read_general(v, shape);
  }
  return shape;
}

void SplitReader::read_fan(std::uint32_t v, const Fan& fan, Shape& shape) {
  const std::size_t n = fan.w.size();
  bool single = false;
  if (fan.closed && n <= 16) {
    const PairOdds::Pair pair = read_pair(v, fan);
    shape.i = pair.i;
    shape.j = pair.j;
  } else {
    single = !fan.closed && is_single_.read(in_);
    if (single) {
      shape.j = in_.index(n);
    } else {
      shape.i = in_.index(n - 1);
      shape.j = shape.i + 1 + in_.index(n - 1 - shape.i);
    }
  }
  for (std::size_t k = 0; k < fan.triangles.size(); ++k) {
    shape.goes.push_back(k >= shape.i && k < shape.j);
  }
  shape.added.push_back({fan.w[shape.j], true});
  if (!single) shape.added.push_back({fan.w[shape.i], false});
  shape.fan = fan;
}

PairOdds::Pair SplitReader::read_pair(std::uint32_t v, const Fan& fan) {
  std::vector<FanVertex> vertices;
  for (const std::uint32_t w : fan.w) {
    vertices.push_back({step(surface_.places[w], surface_.places[v]), surface_.list(w).size(),
                        block_.vertices[w].generation > 0});
  }
  return pair_odds_.read(in_, vertices);
}

void SplitReader::read_general(std::uint32_t v, Shape& shape) {
  Numbers ring;
  for (const std::uint32_t t : shape.triangles) {
    for (const std::uint32_t w : surface_.triangles[t]) {
      if (w == v || std::find(ring.begin(), ring.end(), w) != ring.end()) continue;
      ring.push_back(w);
      if (ring.size() > kLongest) break;
    }
  }
  const std::uint32_t count = added_count_.read(in_);
  demand(count <= block_.limits.triangles - surface_.triangles.size(),
         "more triangles than there are");
  for (std::uint32_t k = 0; k < count; ++k) {
    NewTriangle added;
    if (!ring.empty() && is_in_ring_.read(in_)) {
      added.third = ring[in_.index(ring.size())];
    } else {
      added.third = in_.index(surface_.places.size());
      demand(added.third != v, "a triangle with one vertex twice");
    }
    added.first_leads = first_leads_.read(in_);
    shape.added.push_back(added);
  }
  for (std::size_t k = 0; k < shape.triangles.size(); ++k) {
    const std::size_t which = k == 0 ? 2 : shape.goes[k - 1] ? 1 : 0;
    shape.goes.push_back(goes_[{which}].read(in_));
  }
}

// The lists of a split of the fan.
void SplitReader::apply_fan(std::uint32_t v, std::uint32_t u, const Shape& shape) {
  const std::uint32_t A = static_cast<std::uint32_t>(surface_.triangles.size()), B = A + 1;
  const bool has_B = shape.added.size() > 1;
  Numbers &at_v = surface_.triangles_around[v], &at_u = surface_.triangles_around[u];
  at_v.clear();
  for (std::size_t k = 0; k < shape.triangles.size(); ++k) {
    if (k == shape.j && has_B) at_v.push_back(B);
    if (k == shape.j) at_v.push_back(A);
    (shape.goes[k] ? at_u : at_v).push_back(shape.triangles[k]);
  }
  if (shape.j == shape.triangles.size() && has_B) at_v.push_back(B);
  if (shape.j == shape.triangles.size()) at_v.push_back(A);
  at_u.push_back(A);
  if (has_B) at_u.push_back(B);
  for (const std::uint32_t t : at_u) {
    if (t >= A) continue;
    for (std::uint32_t& corner : surface_.triangles[t]) {
      if (corner == v) corner = u;
    }
  }
  surface_.triangles.push_back({v, u, shape.added[0].third});
  put_beside(shape.added[0].third, A, shape.triangles[shape.j > 0 ? shape.j - 1 : 0], shape.j == 0);
  if (!has_B) return;
  surface_.triangles.push_back({u, v, shape.added[1].third});
  put_beside(shape.added[1].third, B, shape.triangles[shape.i], true);
}

// Into the list of w, before or right after a triangle that is in it.
void SplitReader::put_beside(std::uint32_t w, std::uint32_t t, std::uint32_t beside, bool after) {
  Numbers& list = surface_.triangles_around[w];
  auto at = list.end();
  if (list.size() <= kLongest) at = std::find(list.begin(), list.end(), beside) + (after ? 1 : 0);
  list.insert(at, t);
}

void SplitReader::apply(std::uint32_t v, std::uint32_t u, const Shape& shape) {
  if (shape.fan) return apply_fan(v, u, shape);
  surface_.triangles_around[v].clear();
  for (std::size_t k = 0; k < shape.triangles.size(); ++k) {
    const std::uint32_t t = shape.triangles[k];
    if (shape.goes[k]) {
      for (std::uint32_t& corner : surface_.triangles[t]) {
        if (corner == v) corner = u;
      }
    }
    surface_.triangles_around[shape.goes[k] ? u : v].push_back(t);
  }
  for (const NewTriangle& added : shape.added) {
    surface_.add_triangle(added.first_leads ? Triangle{v, u, added.third}
                                            : Triangle{u, v, added.third});
  }
}

// Positions.
void SplitReader::read_positions(std::uint32_t v, std::uint32_t u, const Point& s,
                                 const Shape& shape) {
  const Surroundings around = surroundings(surface_, v, u, s);
  const bool first_stays = read_stays(0, around, v, u);
  const bool second_stays = read_stays(first_stays ? 2 : 1, around, v, u);
  const bool both = !first_stays && !second_stays;
  Point at_v = s, at_u = s;
  if (both && between_.read_is_between(in_)) {
    read_between(v, u, s, around, shape, at_v, at_u);
  } else {
    if (!second_stays) {
      const Who who = both ? Who::SecondOfBoth : Who::One;
      at_u = read_place(u, s, s, around, child(true, who, u, s, s, shape));
    }
    if (!first_stays) {
      const Who who = both ? Who::FirstOfBoth : Who::One;
      at_v = read_place(v, s, at_u, around, child(false, who, v, s, at_u, shape));
    }
  }
  surface_.places[v] = at_v;
  surface_.places[u] = at_u;
  if (!first_stays) block_.vertices[v].moved = true;
  if (!second_stays) block_.vertices[u].moved = true;
}

bool SplitReader::read_stays(std::size_t question, const Surroundings& around, std::uint32_t v,
                             std::uint32_t u) {
  const float a = length(around.middle[0]), b = length(around.middle[1]);
  const std::size_t share =
      a + b > 0 ? std::min<std::size_t>(static_cast<std::size_t>(16 * a / (a + b)), 15) : 7;
  const std::size_t m = std::min<std::size_t>(surface_.list(v).size(), 9);
  const std::size_t n = std::min<std::size_t>(surface_.list(u).size(), 9);
  const std::size_t order = m < n ? 0 : m == n ? 1 : 2;
  StaysModels& models = stays_[question];
  return read_mixed(in_,
                    {&models.by_share[{share}], &models.by_triangles[{m, n}],
                     &models.by_both[{share / 2, order}]},
                    models.weights);
}

// Sizes.
Miss SplitReader::expected_miss(std::uint32_t v, const Surroundings& around) const {
  float t = 0, n = 0, count = 0;
  for (const std::uint32_t triangle : surface_.first_of_list(v)) {
    for (const std::uint32_t w : surface_.triangles[triangle]) {
      const std::optional<Miss>& miss = block_.vertices[w].miss;
      if (!miss) continue;
      t += miss->tangent;
      n += miss->normal;
      count += 1;
    }
  }
  const float e = around.edge * 0.25f;
  return {(t + e) / (count + 1), (n + 0.25f * e) / (count + 1)};
}

// Components: what they need to know of the child v.
Child SplitReader::child(bool second, Who who, std::uint32_t v, const Point& s,
                         const Point& sibling, const Shape& shape) const {
  Child child;
  child.who = who;
  child.second = second;
  child.triangles = surface_.list(v).size();
  child.sibling = step(sibling, s);
  if (!shape.fan || !shape.fan->closed) return child;
  const std::size_t n = shape.fan->w.size();
  const auto place = [&](std::size_t k) { return step(surface_.places[shape.fan->w[k % n]], s); };
  const std::size_t from = second ? shape.i : shape.j, to = second ? shape.j : shape.i + n;
  child.ring.push_back(child.sibling);
  for (std::size_t k = from; k <= to; ++k) child.ring.push_back(place(k));
  child.before = place(from + n - 1);
  child.after = place(to + 1);
  return child;
}

// Seen coordinates: who is around, where u is known to be at `at_u`.
std::vector<Along> SplitReader::vertices_around(std::uint32_t v, const Point& s, const Point& at_u,
                                                const std::array<std::size_t, 3>& axis) const {
  std::vector<Point> places{s};
  if (at_u != s) places.push_back(at_u);
  for (std::size_t k = 0; k < surface_.list(v).size() && k < 16; ++k) {
    places.push_back(surface_.places[surface_.start_of(surface_.list(v)[k], v)]);
  }
  std::vector<Along> result;
  for (const Point& p : places) {
    result.push_back({less(p.along(axis[0]), s.along(axis[0])),
                      less(p.along(axis[1]), s.along(axis[1])),
                      less(p.along(axis[2]), s.along(axis[2]))});
  }
  return result;
}

Point SplitReader::read_place(std::uint32_t v, const Point& s, const Point& at_u,
                              const Surroundings& around, const Child& child) {
  std::vector<Along> seen_from_here;
  if (seen_.looks()) seen_from_here = vertices_around(v, s, at_u, around.axis);
  SeenPlace seen(seen_, std::size_t(child.who), seen_from_here);
  const Sizes sizes = sizes_of_place(around, expected_miss(v, around));
  Miss miss;
  const std::array<std::int32_t, 3> steps =
      places_[std::size_t(child.who)].read(in_, around, child, sizes, seen, miss);
  block_.vertices[v].miss = miss;
  Point place;
  for (std::size_t k = 0; k < 3; ++k) {
    place.along(around.axis[k]) = sum_of(s.along(around.axis[k]), steps[k]);
  }
  return place;
}

// Between.
void SplitReader::read_between(std::uint32_t v, std::uint32_t u, const Point& s,
                               const Surroundings& around, const Shape& shape, Point& at_v,
                               Point& at_u) {
  const FloatVector& n = around.normal;
  const std::array<std::size_t, 3>& axis = around.axis;
  const Between between = between_.read(in_, length(around.middle[0]), length(around.middle[1]),
                                        {n.along(axis[0]), n.along(axis[1]), n.along(axis[2])});
  const float eighths = float(between.eighths);
  Child second = child(true, Who::SecondBetween, u, s, s, shape);
  second.share = eighths / 8;
  at_u = read_place(u, s, s, around, second);

  Along b;
  for (std::size_t k = 0; k < 3; ++k) b[k] = less(at_u.along(axis[k]), s.along(axis[k]));
  const std::size_t i = (between.axis + 1) % 3, j = (between.axis + 2) % 3;
  Along a{};
  a[i] = read_other(in_, b[i], 0, between.eighths);
  a[j] = read_other(in_, b[j], 0, between.eighths);
  const std::int64_t step = step_of(std::int64_t(a[i]) - b[i], std::int64_t(a[j]) - b[j]);
  const float eighths_of_step = 8 * float(step);
  const Steps steps{between.axis, -(8 - eighths) / eighths_of_step,
                    -(eighths * float(b[between.axis]) + 0.5f) / eighths_of_step};
  Child first = child(false, Who::FirstBetween, v, s, at_u, shape);
  first.share = (8 - eighths) / 8;
  const auto finish = [&](std::int32_t count) {
    return read_other(in_, b[between.axis], -std::int64_t(count) * step, between.eighths);
  };
  Miss miss;
  const Sizes sizes = sizes_of_place(around, expected_miss(v, around));
  a = places_[std::size_t(first.who)].read_steps(in_, around, first, sizes, steps, a, finish, miss);
  block_.vertices[v].miss = miss;
  for (std::size_t k = 0; k < 3; ++k) at_v.along(axis[k]) = sum_of(s.along(axis[k]), a[k]);
}

}  // namespace

void read_splits(RangeDecoder& in, BlockState& block) {
  SplitReader(in, block).read();
}

}  // namespace plain

#include "plain_decoder/seen.h"

#include "plain_decoder/arithmetic.h"

namespace plain {

namespace {

template <std::size_t N>
AdaptiveBit& bit_for(BitsBy<N>& bits, const std::array<std::size_t, N>& of) {
  return bits.try_emplace(of, 0.02, 6).first->second;
}

bool has_one_of(const std::set<std::size_t>& set, std::size_t number) {
  return set.find(number) != set.end();
}

}  // namespace

// Whether a block looks around a place.

bool SeenModels::looks() {
  if (looked_ < 32 || 16 * found_ >= looked_) return true;
  ++passed_;
  return passed_ % 8 == 0;
}

void SeenModels::count(bool is_found) {
  if (is_found) ++found_;
  ++looked_;
  if (looked_ == 256) {
    looked_ /= 2;
    found_ /= 2;
  }
}

void SeenPlace::finish() {
  if (!around_.empty()) models_.count(is_found_);
}

// Coordinates and their classes.

std::vector<SeenPlace::Coordinate> SeenPlace::coordinates(std::size_t axis, std::int32_t plane,
                                                          const Axis& now) {
  std::vector<Coordinate> result;
  for (std::size_t n = 0; n < around_.size(); ++n) {
    const std::int32_t q = less(around_[n][axis], plane);
    auto at = result.begin();
    while (at != result.end() && at->q != q) ++at;
    if (at == result.end()) at = result.insert(at, Coordinate{.q = q, .had_by = {}});
    at->had_by.insert(n);
  }
  std::size_t heaviest = 0;
  for (std::size_t k = 1; k < kComponents; ++k) {
    if (now.weight[k] > now.weight[heaviest]) heaviest = k;
  }
  const float c = now.centre[heaviest], i = now.inverse_scale[heaviest];
  for (Coordinate& of : result) {
    const std::size_t count = of.had_by.size();
    of.away = std::abs(float(of.q) - c) * i;
    of.a = of.away < 0.5f ? 0 : of.away < 1.5f ? 1 : of.away < 5 ? 2 : 3;
    of.s = i > 1 ? 0 : i > 1.0f / 8 ? 1 : i > 1.0f / 64 ? 2 : 3;
    of.m = count == 1 ? 0 : count <= 3 ? 1 : 2;
    of.b = class_before(of.had_by);
    of.likely = is_likely(of, i);
  }
  return result;
}

std::size_t SeenPlace::class_before(const std::set<std::size_t>& had_by) const {
  if (before_.empty()) return 0;
  bool has_all = false;
  for (const std::size_t n : had_by) {
    bool all = true;
    for (const std::set<std::size_t>& others : before_) all = all && has_one_of(others, n);
    has_all = has_all || all;
  }
  return 2 * before_.size() - 1 + (has_all ? 1 : 0);
}

AdaptiveBit& SeenPlace::kind(const Coordinate& of) {
  return bit_for(models_.kind_, {of.s, of.a, of.m, of.b});
}

bool SeenPlace::is_likely(const Coordinate& of, float i) {
  const std::int32_t p = kind(of).p();
  if (p < 1024) return false;
  const float odds = float(p) / 65'536, half = 0.5f * i, factor = 2.75f - 1.7f * odds;
  const float x = of.away - half, y = of.away + half;
  const float chance = 0.5f * (y / std::sqrt(1 + y * y) - x / std::sqrt(1 + x * x));
  return of.away >= 5 || odds >= half * factor || odds >= chance * factor;
}

// Asking.

bool SeenPlace::ask(RangeDecoder& in, std::size_t axis, std::size_t asked, const Coordinate& of) {
  return read_mixed(in,
                    {&kind(of), &bit_for(models_.by_asked_, {axis, asked, of.m}),
                     &bit_for(models_.by_away_, {of.a, of.m, of.b}),
                     &bit_for(models_.by_model_, {model_, axis, of.m})},
                    models_.weights_);
}

void SeenPlace::learn(const std::vector<Coordinate>& all, std::int32_t coded) {
  for (const Coordinate& of : all) {
    if (!of.asked) kind(of).learn(of.q == coded);
    if (of.q == coded) before_.push_back(of.had_by);
  }
}

std::int32_t SeenPlace::read(RangeDecoder& in, std::size_t axis, std::int32_t plane, Axis& now,
                             float size) {
  const std::int32_t start = round_of(now.centre[0]);
  if (around_.empty()) return read_axis(in, now, start, size);
  std::vector<Coordinate> all = coordinates(axis, plane, now);
  std::vector<Coordinate*> likely;
  for (Coordinate& of : all) {
    if (of.likely) likely.push_back(&of);
  }
  std::stable_sort(likely.begin(), likely.end(),
                   [](const Coordinate* a, const Coordinate* b) { return a->away < b->away; });
  for (std::size_t asked = 0; asked < likely.size() && asked < 4; ++asked) {
    Coordinate& of = *likely[asked];
    of.asked = true;
    if (!ask(in, axis, asked, of)) continue;
    is_found_ = true;
    weigh(now, start, less(of.q, start), 1);
    learn(all, of.q);
    return of.q;
  }
  const std::int32_t coded = read_axis(in, now, start, size);
  learn(all, coded);
  return coded;
}

}  // namespace plain

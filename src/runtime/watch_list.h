// What is asked of every active vertex in every frame, four of them at a time: "is this seen to be
// wrong?"
//
//   WatchList watches;
//   watches.resize(slot_count, false);
//   watches.set(slot, error.watch(bounds, position, limit));
//   watches.find<true>(error, odometer, [](std::uint32_t slot) { ... });   // those that are
//
// All that the answer depends on stands in 20 bytes in a row, so a frame streams through memory
// and looks nothing up. Four in a row also have dates, on an odometer of the camera's travels and
// on one of its turns, until which none of the four answers can change; a frame passes over those
// that are not due, looking at the dates of four times four. To date each vertex alone was tried
// before: a fast camera found two thirds of them due in every frame, each for a cache miss or
// three.
//
// What the simplifier leaves of a large model are many roots that have nothing to show, and they
// are numbered along a curve (make_forest()), as their slots are. So 64 in a row have a date as
// well, and a watch that bounds theirs: while that is not wrong, none of them is. One that is set
// widens it, and brings its own date where it is not to be found from where the camera is.
//
// Memory per watch: 22.5 bytes, and 24 more while facing counts.
#pragma once

#include "runtime/view_error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

// How far the camera has come.
struct Odometer {
  double travel = 0, turn = 0;
  float slop = 0;             // what floats may be wrong by, at the least
  float turn_per_travel = 0;  // until now, a guess of what is to come

  static float ratio(double turn, double travel) {
    constexpr float kMost = 1e20f;
    return turn < double(kMost) * travel ? static_cast<float>(turn / travel) : kMost;
  }
};

class WatchList {
 public:
  // New ones are as they last were, or off: never wrong. Facing of old ones is to be set again if
  // it was not kept.
  void resize(std::size_t count, bool with_facing) {
    size_ = count;
    const std::size_t blocks = (count + kLanes - 1) / kLanes;
    if (blocks > spheres_.size()) {
      spheres_.resize(blocks, kOff);
      due_.resize((blocks + kLanes - 1) / kLanes, kNow);
      groups_.resize((due_.size() + kLanes - 1) / kLanes);
    }
    if (!with_facing) return facings_.clear();
    if (spheres_.size() > facings_.size()) facings_.resize(spheres_.size());
  }
  void grow(std::size_t count, bool with_facing) {
    if (count > kLanes * spheres_.size()) return resize(count, with_facing);
    size_ = count;
  }
  void shrink(std::size_t count) { size_ = count; }
  std::size_t size() const { return size_; }

  void set(std::size_t i, const Watch& watch) {
    set_due(i / kLanes, -kNever, -kNever);
    groups_[i / kGroup] = {};
    put(i, watch);
  }
  // The same for one that is not to be found from here; kWrong as for find().
  template <bool kWrong>
  void set(std::size_t i, const Watch& watch, const ViewError& error, const Odometer& now) {
    if (!facings_.empty()) return set(i, watch);
    put(i, watch);
    bring_date(i, due_of<kWrong>(error, from(now), now.turn_per_travel, watch), watch);
  }
  Watch get(std::size_t i) const {
    const std::size_t lane = i % kLanes;
    const Spheres& s = spheres_[i / kLanes];
    Watch watch;
    watch.center = {s.x[lane], s.y[lane], s.z[lane]};
    watch.reach = s.reach[lane], watch.radius = s.radius[lane];
    if (facings_.empty()) return watch;
    const Facings& f = facings_[i / kLanes];
    watch.axis = {f.x[lane], f.y[lane], f.z[lane]};
    watch.sine = f.sine[lane], watch.cosine = f.cosine[lane];
    watch.reach_aside = f.reach_aside[lane];
    return watch;
  }
  // It is what another one was, and not to be found any sooner.
  void set_as(std::size_t i, std::size_t from) {
    const Watch watch = get(from);
    if (!facings_.empty()) return set(i, watch);
    put(i, watch);
    const Dates& dates = due_[from / kLanes / kLanes];
    const std::size_t lane = from / kLanes % kLanes;
    bring_date(i, {dates.travel[lane], dates.turn[lane]}, watch);
  }
  void prefetch(std::size_t i) const {
    const char* const spheres = reinterpret_cast<const char*>(&spheres_[i / kLanes]);
    __builtin_prefetch(spheres);
    __builtin_prefetch(spheres + 64);
    __builtin_prefetch(&due_[i / kLanes / kLanes]);
  }
  void turn_off(std::size_t i) { put(i, {}); }  // never found, so no date comes sooner
  void look_at_all() {
    due_.assign(due_.size(), kNow);
    groups_.assign(groups_.size(), {});
  }

  // Calls found(i), ascending, for each that is seen to be wrong, or for each other one. Returns
  // how many it looked at. `all_move`: each that is found will be set, turned off or dropped before
  // the next find(), so it need not be looked at again as it is.
  template <bool kWrong, typename Found>
  std::size_t find(const ViewError& error, const Odometer& now, Found found,
                   bool all_move = false) {
    const auto travel = static_cast<float>(now.travel), turn = static_cast<float>(now.turn);
    const Date from = WatchList::from(now);
    const float again = all_move && facings_.empty() ? kNever : -kNever;
    std::size_t looked_at = 0;
    const std::size_t block_count = (size_ + kLanes - 1) / kLanes;
    for (std::size_t g = 0; g * kGroup < size_; ++g) {
      if (groups_[g].due.travel > travel && groups_[g].due.turn > turn) continue;
      if (kWrong && groups_[g].has_bound()) {
        ++looked_at;
        if (is_far(error, from, groups_[g])) continue;
      }
      // Where the next due one is nobody can foretell: their bits first, then one loop.
      constexpr std::size_t kBlocks = kGroup / kLanes;
      const std::size_t first = g * kBlocks;
      Dates later{FourFloats{} + kNever, FourFloats{} + kNever};  // of those that are not due
      std::uint32_t left = 0;
      const std::size_t end = std::min(due_.size(), (first + kBlocks) / kLanes);
      for (std::size_t i = first / kLanes; i < end; ++i) {
        const Dates& due = due_[i];
        const FourInts is_due = (due.travel <= travel) | (due.turn <= turn);
        left |= negative_lanes(is_due) << (kLanes * i - first);
        later.travel = lesser(or_nan(due.travel, is_due), later.travel);
        later.turn = lesser(or_nan(due.turn, is_due), later.turn);
      }
      if (block_count < first + kBlocks) left &= (1u << (block_count - first)) - 1;
      Date next{least(later.travel), least(later.turn)};
      for (; left != 0; left &= left - 1) {
        const std::size_t b = first + static_cast<std::size_t>(std::countr_zero(left));
        looked_at += kLanes;
        Date due;
        std::uint32_t hit = look<kWrong>(error, from, now.turn_per_travel, again, b, due);
        set_due(b, due.travel, due.turn);
        next = {lesser(due.travel, next.travel), lesser(due.turn, next.turn)};
        for (; hit != 0; hit &= hit - 1) {
          const std::size_t i = kLanes * b + static_cast<std::size_t>(std::countr_zero(hit));
          if (i < size_) found(static_cast<std::uint32_t>(i));
        }
      }
      groups_[g].due = next;
      if (kWrong && facings_.empty()) keep_bound(g);
    }
    return looked_at;
  }

  // How much farther the camera may travel, and turn, with no answer to change; negative: now.
  struct Slack {
    double travel, turn;
  };
  Slack slack(const Odometer& now) const {
    Date first{kNever, kNever};
    for (std::size_t g = 0; g * kGroup < size_; ++g) {
      first.travel = std::min(first.travel, groups_[g].due.travel);
      first.turn = std::min(first.turn, groups_[g].due.turn);
    }
    return {double(first.travel) - now.travel, double(first.turn) - now.turn};
  }

  std::size_t bytes() const {
    return sizeof(Spheres) * spheres_.capacity() + sizeof(Facings) * facings_.capacity() +
           sizeof(Dates) * due_.capacity() + sizeof(Group) * groups_.capacity();
  }

 private:
  static constexpr std::size_t kLanes = 4, kGroup = 64;
  struct Spheres {
    FourFloats x, y, z, reach, radius;
  };
  struct Facings {
    FourFloats x, y, z, sine, cosine, reach_aside;
  };
  struct Date {
    float travel, turn;
  };
  struct Dates {  // of four blocks
    FourFloats travel, turn;
  };
  struct Group {
    Date due{-kNever, -kNever};
    Vec3f center;
    float reach = 0, radius = 0;
    std::uint32_t finds = 0;    // how often it was looked at
    std::uint32_t widened = 0;  // how often since it was bounded

    bool has_bound() const { return finds > kFindsToBound; }
  };
  static constexpr std::uint32_t kFindsToBound = 1, kMostWidened = kGroup;
  static constexpr float kRounding = 1e-6f, kSafe = 0.999f, kFar = 1e15f;
  static constexpr Dates kNow{{-kNever, -kNever, -kNever, -kNever},
                              {-kNever, -kNever, -kNever, -kNever}};
  static constexpr Spheres kOff{{}, {}, {}, {-kNever, -kNever, -kNever, -kNever}, {}};

  void put(std::size_t i, const Watch& watch) {
    const std::size_t lane = i % kLanes;
    Spheres& s = spheres_[i / kLanes];
    s.x[lane] = watch.center.x, s.y[lane] = watch.center.y, s.z[lane] = watch.center.z;
    s.reach[lane] = watch.reach;
    s.radius[lane] = watch.radius;
    if (facings_.empty()) return;
    Facings& f = facings_[i / kLanes];
    f.x[lane] = watch.axis.x, f.y[lane] = watch.axis.y, f.z[lane] = watch.axis.z;
    f.sine[lane] = watch.sine, f.cosine[lane] = watch.cosine;
    f.reach_aside[lane] = watch.reach_aside;
  }
  void bring_date(std::size_t i, const Date& due, const Watch& watch) {
    Dates& four = due_[i / kLanes / kLanes];
    const std::size_t lane = i / kLanes % kLanes;
    four.travel[lane] = lesser(due.travel, four.travel[lane]);
    four.turn[lane] = lesser(due.turn, four.turn[lane]);
    Group& group = groups_[i / kGroup];
    group.due = {lesser(due.travel, group.due.travel), lesser(due.turn, group.due.turn)};
    if (group.has_bound()) widen(group, watch);
  }
  // So much sooner that no rounding makes a date late.
  static Date from(const Odometer& now) {
    return {static_cast<float>(now.travel * (1 - 1e-6)) - now.slop,
            static_cast<float>(now.turn * (1 - 1e-6)) - kRounding};
  }
  // How far the camera may travel, and turn so much with it, until a plane comes to what is `aside`
  // of it. A plane moves by what the eye travels, and by what it turns times the distance; each may
  // use up a share, and for a camera that goes on as it came both are used up at once.
  template <typename Real>
  static Real until_planes(float turn_per_travel, const Real& distance, const Real& aside) {
    const Real near_aside = lesser(aside, Real{} + kFar);
    return near_aside / (1 + turn_per_travel * (distance + near_aside));
  }
  // As look() of four.
  template <bool kWrong>
  static Date due_of(const ViewError& error, const Date& from, float turn_per_travel,
                     const Watch& w) {
    if (w.reach == -kNever) return kWrong ? Date{kNever, kNever} : Date{-kNever, -kNever};
    const float distance = error.distance(w.center.x, w.center.y, w.center.z);
    const float gap = magnitude(w.reach - distance);
    if (kWrong && !(distance < w.reach)) {
      return {from.travel + kSafe * (gap - kRounding * distance), kNever};
    }
    const float inside = error.inside(w.center.x, w.center.y, w.center.z) + w.radius;
    if ((inside >= 0) == kWrong || !(distance < w.reach)) return {-kNever, -kNever};
    const float by_planes = until_planes(turn_per_travel, distance, magnitude(inside));
    const float travel = (kWrong ? by_planes : lesser(gap, by_planes)) - kRounding * distance;
    return {from.travel + kSafe * travel, from.turn + kSafe * turn_per_travel * by_planes};
  }
  static void widen(Group& group, const Watch& w) {
    constexpr float kMore = 1 + 1e-5f;
    if (w.reach == -kNever) return;
    const Vec3f aside = w.center - group.center;
    const float distance = kMore * root(dot(aside, aside));
    group.reach = std::max(group.reach, kMore * (distance + w.reach));
    group.radius = std::max(group.radius, kMore * (distance + w.radius));
    ++group.widened;
  }

  // Whether no watch of the group can be wrong; then it is dated.
  static bool is_far(const ViewError& error, const Date& from, Group& g) {
    const Vec3f& c = g.center;
    const float distance = error.distance(c.x, c.y, c.z);
    if (distance >= g.reach) {
      g.due = {from.travel + kSafe * (distance - g.reach), kNever};
      return true;
    }
    const float outside = -(error.inside(c.x, c.y, c.z) + g.radius);
    if (!(outside > 0)) return false;
    const float half = 0.5f * outside;
    g.due = {from.travel + kSafe * (half - kRounding * distance),
             from.turn + kSafe * (half / (distance + half))};
    return true;
  }

  // The group was looked at.
  void keep_bound(std::size_t g) {
    Group& group = groups_[g];
    if (group.has_bound() ? group.widened > kMostWidened : ++group.finds > kFindsToBound) {
      bound(g);
    }
  }

  // A sphere around what is on; somewhat larger, so that no rounding matters.
  void bound(std::size_t g) {
    const std::size_t begin = g * kGroup / kLanes;
    const std::size_t end = std::min(spheres_.size(), begin + kGroup / kLanes);
    const FourFloats never = FourFloats{} + kNever;
    FourFloats low[3] = {never, never, never}, high[3] = {-never, -never, -never};
    for (std::size_t b = begin; b < end; ++b) {
      const Spheres& s = spheres_[b];
      const FourInts is_on = s.reach > -kNever;
      const FourFloats* const at[3] = {&s.x, &s.y, &s.z};
      for (int k = 0; k < 3; ++k) {
        low[k] = lesser(is_on ? *at[k] : never, low[k]);
        high[k] = greater(is_on ? *at[k] : -never, high[k]);
      }
    }
    Group& group = groups_[g];
    group.widened = 0;
    float middle[3];
    for (int k = 0; k < 3; ++k) middle[k] = 0.5f * (least(low[k]) - least(-high[k]));
    if (!(least(low[0]) < kNever)) middle[0] = middle[1] = middle[2] = 0;
    group.center = {middle[0], middle[1], middle[2]};
    FourFloats reach = -never, radius{};
    for (std::size_t b = begin; b < end; ++b) {
      const Spheres& s = spheres_[b];
      const FourFloats x = s.x - middle[0], y = s.y - middle[1], z = s.z - middle[2];
      const FourFloats aside = root(x * x + y * y + z * z);
      const FourInts is_on = s.reach > -kNever;
      reach = greater(is_on ? aside + s.reach : -never, reach);
      radius = greater(is_on ? aside + s.radius : FourFloats{}, radius);
    }
    constexpr float kMore = 1e-5f;
    const float slack =
        kMore * (magnitude(middle[0]) + magnitude(middle[1]) + magnitude(middle[2]));
    group.reach = (1 + kMore) * -least(-reach) + slack;
    group.radius = (1 + kMore) * -least(-radius) + slack;
  }

  // The lanes to be found, and the date of all four; `again` of those that are found.
  //
  // Without branches: whether something is near, but out of view, nobody can foretell.
  template <bool kWrong>
  std::uint32_t look(const ViewError& error, const Date& from, float turn_per_travel, float again,
                     std::size_t b, Date& due) const {
    const Spheres& s = spheres_[b];
    const FourFloats never = FourFloats{} + kNever;
    const FourFloats distance = error.distance(s.x, s.y, s.z);
    const FourInts is_near = distance < reach_of(error, b);
    const FourFloats inside = error.inside(s.x, s.y, s.z) + s.radius;
    const FourInts is_wrong = is_near & (inside >= 0);
    const FourInts hit = kWrong ? is_wrong : ~is_wrong;
    if (!facings_.empty()) {  // what faces where changes sooner
      due = {-kNever, -kNever};
      return negative_lanes(hit);
    }
    const FourFloats gap = magnitude(s.reach - distance);
    const FourFloats by_planes = until_planes(turn_per_travel, distance, magnitude(inside));
    const FourFloats travel =
        (kWrong ? (is_near ? by_planes : gap) : lesser(gap, by_planes)) - kRounding * distance;
    const FourFloats by_turn = turn_per_travel * by_planes;
    const FourFloats turn = kWrong ? (is_near ? by_turn : never) : by_turn;
    const FourFloats hits = FourFloats{} + again;
    due = {from.travel + kSafe * least(hit ? hits : travel),
           from.turn + kSafe * least(hit ? hits : turn)};
    return negative_lanes(hit);
  }

  // Which lesser(x, y) passes over, if it is x.
  static FourFloats or_nan(const FourFloats& x, const FourInts& is_nan) {
    return std::bit_cast<FourFloats>(std::bit_cast<FourInts>(x) | is_nan);
  }
  void set_due(std::size_t b, float travel, float turn) {
    due_[b / kLanes].travel[b % kLanes] = travel;
    due_[b / kLanes].turn[b % kLanes] = turn;
  }

  FourFloats reach_of(const ViewError& error, std::size_t b) const {
    const Spheres& s = spheres_[b];
    if (facings_.empty()) return s.reach;
    const Facings& f = facings_[b];
    return error.facing_reach(s.x, s.y, s.z, s.reach, s.radius, f.x, f.y, f.z, f.sine, f.cosine,
                              f.reach_aside);
  }

  std::vector<Spheres> spheres_;
  std::vector<Facings> facings_;  // or empty
  std::vector<Dates> due_;        // per four of them
  std::vector<Group> groups_;     // per four of those
  std::size_t size_ = 0;
};

}  // namespace crease

// What is asked of every active vertex in every frame, four of them at a time: "is this seen to be
// wrong?"
//
//   WatchList watches;
//   watches.resize(slot_count);
//   watches.set(slot, error.watch(bounds, position, limit));
//   watches.find<true>(error, [](std::uint32_t slot) { ... });   // those that are
//
// All that the answer depends on stands in 20 bytes in a row, so a frame streams through memory
// and looks nothing up: 1 to 2 ns a watch (bench/refine). To keep a date at which each answer may
// change, and to look only at those that are due, was tried before: the dates of a fast camera were
// so near that two thirds of the vertices were due in every frame, each for a cache miss or three.
//
// Memory per watch: 20 bytes, and 24 more while facing counts.
#pragma once

#include "runtime/view_error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

class WatchList {
 public:
  // New ones are as they last were, or off: never wrong. Facing of old ones is to be set again if
  // it was not kept.
  void resize(std::size_t count, bool with_facing) {
    size_ = count;
    const std::size_t blocks = (count + kLanes - 1) / kLanes;
    if (blocks > spheres_.size()) spheres_.resize(blocks, kOff);
    if (!with_facing) return facings_.clear();
    if (spheres_.size() > facings_.size()) facings_.resize(spheres_.size());
  }
  std::size_t size() const { return size_; }

  void set(std::size_t i, const Watch& watch) {
    const std::size_t lane = i % kLanes;
    Spheres& s = spheres_[i / kLanes];
    s.x[lane] = watch.center.x, s.y[lane] = watch.center.y, s.z[lane] = watch.center.z;
    s.reach2[lane] = watch.reach2;
    s.radius[lane] = watch.radius;
    if (facings_.empty()) return;
    Facings& f = facings_[i / kLanes];
    f.x[lane] = watch.axis.x, f.y[lane] = watch.axis.y, f.z[lane] = watch.axis.z;
    f.sine[lane] = watch.sine, f.cosine[lane] = watch.cosine;
    f.reach2_aside[lane] = watch.reach2_aside;
  }
  Watch get(std::size_t i) const {
    const std::size_t lane = i % kLanes;
    const Spheres& s = spheres_[i / kLanes];
    Watch watch;
    watch.center = {s.x[lane], s.y[lane], s.z[lane]};
    watch.reach2 = s.reach2[lane], watch.radius = s.radius[lane];
    if (facings_.empty()) return watch;
    const Facings& f = facings_[i / kLanes];
    watch.axis = {f.x[lane], f.y[lane], f.z[lane]};
    watch.sine = f.sine[lane], watch.cosine = f.cosine[lane];
    watch.reach2_aside = f.reach2_aside[lane];
    return watch;
  }
  void turn_off(std::size_t i) { set(i, {}); }
  void prefetch(std::size_t i) const { __builtin_prefetch(&spheres_[i / kLanes]); }

  // Calls found(i), ascending, for each that is seen to be wrong, or for each other one.
  template <bool kWrong, typename Found>
  void find(const ViewError& error, Found found) const {
    for (std::size_t b = 0; kLanes * b < size_; ++b) {
      const Spheres& s = spheres_[b];
      const Int4 is_near = error.is_near(s.x, s.y, s.z, reach2_of(error, b));
      // Hardly any of what is not split is near, unless it is out of view.
      if (kWrong && !any(is_near)) continue;
      const Int4 is_wrong = is_near & error.is_in_view(s.x, s.y, s.z, s.radius);
      const Int4 hit = kWrong ? is_wrong : ~is_wrong;
      if (!any(hit)) continue;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t i = kLanes * b + lane;
        if (hit[lane] != 0 && i < size_) found(static_cast<std::uint32_t>(i));
      }
    }
  }

  std::size_t bytes() const {
    return sizeof(Spheres) * spheres_.capacity() + sizeof(Facings) * facings_.capacity();
  }

 private:
  static constexpr std::size_t kLanes = 4;
  struct Spheres {
    Float4 x, y, z, reach2, radius;
  };
  struct Facings {
    Float4 x, y, z, sine, cosine, reach2_aside;
  };
  Float4 reach2_of(const ViewError& error, std::size_t b) const {
    const Spheres& s = spheres_[b];
    if (facings_.empty()) return s.reach2;
    const Facings& f = facings_[b];
    return error.reach2(s.x, s.y, s.z, s.reach2, s.radius, f.x, f.y, f.z, f.sine, f.cosine,
                        f.reach2_aside);
  }

  static constexpr Spheres kOff{{}, {}, {}, {-1, -1, -1, -1}, {}};

  std::vector<Spheres> spheres_;
  std::vector<Facings> facings_;  // or empty
  std::size_t size_ = 0;
};

}  // namespace crease

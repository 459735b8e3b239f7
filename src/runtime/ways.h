// Numbered things on their way from where they were seen to where they belong: slots, normals.
//
//   ways.set(slot, {from, to, now});
//   shown = ways.at(slot, own, now, seconds)
//
// Memory and time: O(those on their way).
#pragma once

#include "crease/vec.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace crease {

struct Way {
  Vec3f from, to;
  double began = 0;
  bool is_leaving = false;  // to where it will be contracted: not its own place
};

class Ways {
 public:
  using Interpolate = Vec3f (*)(const Vec3f& from, const Vec3f& to, float share);
  explicit Ways(Interpolate interpolate) : interpolate_(interpolate) {}

  bool empty() const { return ways_.empty(); }
  const Way* find(std::uint32_t i) const {
    const auto found = ways_.find(i);
    return found == ways_.end() ? nullptr : &found->second;
  }
  Vec3f shown(const Way& way, double now, double seconds) const {
    const float share = seconds > 0 ? static_cast<float>((now - way.began) / seconds) : 1.0f;
    return interpolate_(way.from, way.to, share);
  }
  // Of something whose own place is `own`; nothing is on a way to where it is.
  void set(std::uint32_t i, const Vec3f& own, const Way& way) {
    if (way.from == way.to && way.to == own) {
      ways_.erase(i);
    } else {
      ways_[i] = way;
    }
  }
  void erase(std::uint32_t i) { ways_.erase(i); }

  // Calls visit(i, way) for each; erases where it returns true.
  template <typename Visit>
  void visit_and_erase(Visit visit) {
    for (auto at = ways_.begin(); at != ways_.end();) {
      at = visit(at->first, at->second) ? ways_.erase(at) : std::next(at);
    }
  }

 private:
  Interpolate interpolate_;
  std::unordered_map<std::uint32_t, Way> ways_;
};

}  // namespace crease

// Errors in the units of LevelError, each rounded up, as SplitBounds holds them.
#pragma once

#include "crease/contraction.h"
#include "crease/split_bounds.h"

#include <limits>

namespace crease {

// A LevelError, rounded up.
struct RoundedError {
  RoundedUp surface, line, degrees, texture;

  static RoundedError from(const LevelError& error) {
    const auto rounded = [](float x) {
      return RoundedUp::from(x >= 0 ? x : std::numeric_limits<float>::infinity());  // or no number
    };
    return {rounded(error.surface), rounded(error.line), rounded(error.degrees),
            rounded(error.texture)};
  }
  LevelError value() const {
    return {surface.value(), line.value(), degrees.value(), texture.value()};
  }
  bool operator==(const RoundedError&) const = default;
};

inline RoundedUp worse(RoundedUp a, RoundedUp b) {
  return a.bits > b.bits ? a : b;
}
// Unit by unit.
inline RoundedError worse(const RoundedError& a, const RoundedError& b) {
  return {worse(a.surface, b.surface), worse(a.line, b.line), worse(a.degrees, b.degrees),
          worse(a.texture, b.texture)};
}
inline RoundedError error_of(const SplitBounds& bounds) {
  return {bounds.surface, bounds.line, bounds.degrees, bounds.texture};
}
inline void set_error(SplitBounds& bounds, const RoundedError& error) {
  bounds.surface = error.surface;
  bounds.line = error.line;
  bounds.degrees = error.degrees;
  bounds.texture = error.texture;
}

}  // namespace crease

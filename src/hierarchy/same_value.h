// How near a solved attribute is to one that is there already for it to be that one, which costs no
// record: so near that nobody sees it.
#pragma once

namespace crease {

struct SameValue {
  double joined = 1e-3;  // of what several become
  double moved = 2e-2;   // of a wedge that only moved along
};

// Of texture coordinates, where a mean edge is so many units long: it moves by a small part of
// that.
inline SameValue same_texture(double edge) {
  constexpr double kShareOfEdge = 0.02;
  return {kShareOfEdge * edge, kShareOfEdge * edge};
}

// Of numbers that mean nothing to us, over their range.
inline SameValue same_number(double range) {
  constexpr double kShareOfRange = 1e-3;
  return {kShareOfRange * range, kShareOfRange * range};
}

}  // namespace crease

#include "plain_decoder/value_map.h"

namespace plain {

Expected expected_by_map(const std::vector<Sample>& samples, const FloatVector& normal,
                         std::size_t numbers) {
  if (samples.empty()) return {{}, kDoubts - 1};
  const FloatVector sizes = sizes_of(normal);
  std::size_t third = 0;
  for (const std::size_t axis : {1, 2}) {
    if (sizes.along(axis) > sizes.along(third)) third = axis;
  }
  const std::size_t first = (third + 1) % 3, second = (third + 2) % 3;
  float squares = 0;
  for (const Sample& s : samples) squares += dot(s.place, s.place);
  const float near = squares > 0 ? 0.05f * (squares / float(samples.size())) : 1;
  const auto weight = [&](const Sample& s) { return 1 / (dot(s.place, s.place) + near); };

  float W = 0, X = 0, Y = 0, XX = 0, XY = 0, YY = 0;
  for (const Sample& s : samples) {
    const float w = weight(s), x = s.place.along(first), y = s.place.along(second);
    W += w;
    X += w * x;
    Y += w * y;
    XX += w * x * x;
    XY += w * x * y;
    YY += w * y * y;
  }
  const float mx = X / W, my = Y / W;
  XX -= X * mx;
  XY -= X * my;
  YY -= Y * my;
  const float more = 0.006f * (XX + YY);
  XX += more;
  YY += more;
  const float D = XX * YY - XY * XY;

  Expected expected;
  float off = 0;
  for (std::size_t k = 0; k < numbers; ++k) {
    const std::int32_t base = samples[0].code[k];
    const auto value = [&](const Sample& s) { return float(less(s.code[k], base)); };
    float U = 0, XU = 0, YU = 0;
    for (const Sample& s : samples) {
      const float w = weight(s);
      U += value(s) * w;
      XU += value(s) * (w * s.place.along(first));
      YU += value(s) * (w * s.place.along(second));
    }
    XU -= U * mx;
    YU -= U * my;
    const float inverse = D > 0 ? 1 / D : 0;
    const float gx = D > 0 ? (XU * YY - YU * XY) * inverse : 0;
    const float gy = D > 0 ? (YU * XX - XU * XY) * inverse : 0;
    const float here = U * (1 / W) - gx * mx - gy * my;
    float off_of_k = 0;
    for (const Sample& s : samples) {
      const float rest = value(s) - here - gx * s.place.along(first) - gy * s.place.along(second);
      off_of_k += rest * rest * weight(s);
    }
    off += off_of_k;
    const float x = here + 0.5f;
    const bool is_near = x > -1e9f && x < 1e9f;
    expected.code[k] = sum_of(base, is_near ? std::int32_t(std::floor(x)) : 0);
  }
  const float doubt = log2_of(std::min(off / W, 1e12f) + 1) * 0.5f;
  expected.doubt = std::min(std::size_t(doubt), kDoubts - 1);
  return expected;
}

}  // namespace plain

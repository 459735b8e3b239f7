#include "crease/compare.h"

#include "base/assert.h"
#include "measure/furthest.h"
#include "measure/look_for_each.h"
#include "measure/sample.h"
#include "measure/shared_attributes.h"
#include "measure/surface.h"
#include "parallel/parallel.h"
#include "parallel/shared_progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace crease {

namespace {

constexpr std::size_t kMostSamples = 1'000'000'000;

// Two triangles count as equally near when their distances differ by less than this share of the
// diagonal without strays: a sample on a hard edge sees both sides of it.
constexpr double kTie = 1e-5;
// Frame units: nothing that is less wrong than this is found out.
constexpr double kRounding = 1e-9;
// Further apart, in sizes of the larger, everything is equally near, as far as the floats of a
// search can tell, and each sample would look at every triangle.
constexpr double kMostApart = 1000;
// What bounds the work where distances are nearly the same all over a surface.
constexpr std::size_t kQueriesATriangle = 16, kQueriesAtLeast = 1'000'000;

struct OneWay {
  std::vector<double> distance;                   // frame units, per sample
  std::vector<double> deviation;                  // radians, per sample
  std::vector<std::vector<double>> of_attribute;  // deviations, per shared attribute and sample
  Furthest furthest;                              // frame units
};

// Per sample into arrays of its own, so that sums do not depend on how threads share the work.
// `side`: 0 from a to b, 1 from b to a.
OneWay measure_samples(const Surface& from, const Surface& to, const SharedAttributes& shared,
                       std::size_t side, const CompareOptions& options, double tie,
                       SharedProgress& progress) {
  OneWay result;
  result.distance.resize(options.samples);
  result.deviation.resize(options.samples);
  result.of_attribute.resize(shared.count(), std::vector<double>(options.samples));
  const Sampler sampler(from, options.samples, options.seed);
  const auto is_over = [&] { return progress.stopped(); };
  look_for_each(options.samples, progress, is_over, [&](std::size_t i, Surface::Scratch& scratch) {
    const SurfacePoint sample = sampler(i);
    Vec3d p;
    for (std::size_t c = 0; c < 3; ++c) {
      p += from.corner(sample.triangle, c) * sample.weights[c];
    }
    const Vec3d normal = from.normal(sample.triangle, sample.weights);
    const Nearest nearest = to.nearest(p, &normal, tie, scratch);
    result.distance[i] = nearest.distance;
    result.deviation[i] = nearest.deviation_rad;
    for (std::size_t k = 0; k < shared.count(); ++k) {
      result.of_attribute[k][i] = shared.deviation(k, sample, scratch.candidates, side);
    }
  });
  for (double d : result.distance) {
    result.furthest.distance = std::max(result.furthest.distance, d);
  }
  return result;
}

std::size_t max_queries(const Surface& from, const Surface& to) {
  return kQueriesATriangle * (from.triangle_count() + to.triangle_count()) + kQueriesAtLeast;
}

OneWay measure_way(const Surface& from, const Surface& to, const SharedAttributes& shared,
                   std::size_t side, const CompareOptions& options, double tie,
                   SharedProgress& progress) {
  OneWay way = measure_samples(from, to, shared, side, options, tie, progress);
  way.furthest = find_furthest(from, to,
                               {.at_least = way.furthest.distance,
                                .relative = kMaxTolerance,
                                .absolute = kRounding,
                                .max_queries = max_queries(from, to)},
                               progress);
  return way;
}

Spread spread_of(const OneWay& way, double scale) {
  Spread spread{.max = way.furthest.distance / scale, .bound = way.furthest.bound / scale};
  if (way.distance.empty()) return spread;
  double sum = 0, sum_of_squares = 0;
  for (double d : way.distance) {
    sum += d;
    sum_of_squares += d * d;
  }
  const double count = double(way.distance.size());
  spread.mean = sum / count / scale;
  spread.rms = std::sqrt(sum_of_squares / count) / scale;
  return spread;
}

// Adds the others, and reorders.
DeviationSpread spread_of_both(std::vector<double>& deviations, const std::vector<double>& others) {
  DeviationSpread spread;
  deviations.insert(deviations.end(), others.begin(), others.end());
  if (deviations.empty()) return spread;
  double sum = 0;
  for (const double d : deviations) sum += d;
  spread.mean = sum / double(deviations.size());
  const auto p95 = deviations.begin() + std::ptrdiff_t((deviations.size() - 1) * 95 / 100);
  std::nth_element(deviations.begin(), p95, deviations.end());
  spread.p95 = *p95;
  spread.max = *std::max_element(p95, deviations.end());
  return spread;
}

// How far there is to go beside the samples.
std::size_t size_of(const Mesh& a, const Mesh& b) {
  return a.vertex_count() + b.vertex_count() + a.triangle_count() + b.triangle_count();
}

Result<Comparison> compare(const Mesh& a, const Mesh& b, const CompareOptions& options) {
  const Frame frame = common_frame(a, b);
  if (frame.gap > kMostApart * frame.larger) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "compare: the two are %.3g apart, %.0f times the size of the larger: has one another "
        "axis up, other units, or lost its origin?",
        frame.gap, frame.gap / frame.larger);
    return fail(Error::BadValue, line);
  }
  const double tie = kTie * frame.size * frame.scale;
  const Surface surface_a(a, frame), surface_b(b, frame);

  SharedProgress progress(options.progress, "compare", 2 * options.samples + size_of(a, b));
  const SharedAttributes shared(a, b);
  OneWay a_to_b = measure_way(surface_a, surface_b, shared, 0, options, tie, progress);
  OneWay b_to_a = measure_way(surface_b, surface_a, shared, 1, options, tie, progress);
  if (progress.stopped()) return fail(Error::Interrupted, "compare: interrupted");

  Comparison result;
  result.diagonal = frame.diagonal;
  result.samples = options.samples;
  result.distance.a_to_b = spread_of(a_to_b, frame.scale);
  result.distance.b_to_a = spread_of(b_to_a, frame.scale);

  const DeviationSpread normals = spread_of_both(a_to_b.deviation, b_to_a.deviation);
  result.normal_deviation = {
      .mean = degrees(normals.mean), .p95 = degrees(normals.p95), .max = degrees(normals.max)};
  for (std::size_t k = 0; k < shared.count(); ++k) {
    result.attributes.push_back({shared.name(k), shared.unit(k),
                                 spread_of_both(a_to_b.of_attribute[k], b_to_a.of_attribute[k])});
  }
  return result;
}

Result<bool> within(const Mesh& a, const Mesh& b, double distance, const CompareOptions& options) {
  const Frame frame = common_frame(a, b);
  const Surface surface_a(a, frame), surface_b(b, frame);
  SharedProgress progress(options.progress, "compare", size_of(a, b));
  const auto is_within = [&](const Surface& from, const Surface& to) {
    const double limit = distance * frame.scale;
    const FurthestOptions wanted{.at_least = limit,
                                 .absolute = kRounding,
                                 .any_will_do = true,
                                 .max_queries = max_queries(from, to)};
    // What was found may be further by one rounding and its bound by one more.
    return find_furthest(from, to, wanted, progress).bound <= limit + 2 * kRounding;
  };
  const bool both = is_within(surface_b, surface_a) && is_within(surface_a, surface_b);
  if (progress.stopped()) return fail(Error::Interrupted, "compare: interrupted");
  return both;
}

void check_comparable(const Mesh& a, const Mesh& b) {
  CREASE_ASSERT(a.triangle_count() > 0 && b.triangle_count() > 0);
  CREASE_ASSERT(a.normals() != nullptr && b.normals() != nullptr);
}

}  // namespace

Result<Comparison> compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options) {
  check_comparable(a, b);
  if (options.samples > kMostSamples) {
    return fail(Error::BadValue, std::to_string(options.samples) + " samples: at most " +
                                     std::to_string(kMostSamples));
  }
  return run_on(options.threads, [&] { return compare(a, b, options); });
}

Result<bool> meshes_within(const Mesh& a, const Mesh& b, double distance,
                           const CompareOptions& options) {
  check_comparable(a, b);
  if (std::isnan(distance)) return fail(Error::BadValue, "within a distance that is no number");
  return run_on(options.threads, [&] { return within(a, b, distance, options); });
}

std::vector<float> distances_to(const Mesh& surface, std::span<const Vec3d> points, int threads) {
  CREASE_ASSERT(surface.triangle_count() > 0 && surface.normals() != nullptr);
  return run_on(threads, [&] {
    const Frame frame = common_frame(surface, surface);
    const Surface to(surface, frame);
    std::vector<float> distance_of_point(points.size());
    parallel_ranges(points.size(), kLooksATask, [&](std::size_t begin, std::size_t end) {
      Surface::Scratch scratch;
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3d p = frame.to_frame(points[i]);
        const Nearest nearest = to.nearest(p, nullptr, 0, scratch);
        distance_of_point[i] = float(nearest.distance / frame.scale);
      }
    });
    return distance_of_point;
  });
}

}  // namespace crease

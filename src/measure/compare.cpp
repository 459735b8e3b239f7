#include "crease/compare.h"

#include "base/assert.h"
#include "measure/sample.h"
#include "measure/surface.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

namespace crease {

namespace {

// Two triangles count as equally near when their distances differ by less than this share of the
// diagonal: a sample on a hard edge sees both sides of it.
constexpr double kTie = 1e-5;
constexpr std::size_t kGrain = 512;

struct OneWay {
  std::vector<double> distance;   // frame units, per sample
  std::vector<double> deviation;  // radians, per sample
  double max = 0;                 // frame units, vertices included
};

// Per sample into arrays of its own, so that sums do not depend on how threads share the work.
OneWay measure_samples(const Surface& from, const Surface& to, const CompareOptions& options,
                       double tie) {
  OneWay result;
  result.distance.resize(options.samples);
  result.deviation.resize(options.samples);
  const Sampler sampler(from, options.samples, options.seed);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, options.samples, kGrain),
                    [&](const auto& range) {
                      Surface::Scratch scratch;
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        const SurfacePoint sample = sampler(i);
                        Vec3d p;
                        for (std::size_t c = 0; c < 3; ++c) {
                          p += from.corner(sample.triangle, c) * sample.weights[c];
                        }
                        const Vec3d normal = from.normal(sample.triangle, sample.weights);
                        const Nearest nearest = to.nearest(p, &normal, tie, scratch);
                        result.distance[i] = nearest.distance;
                        result.deviation[i] = nearest.deviation_rad;
                      }
                    });
  for (double d : result.distance) result.max = std::max(result.max, d);
  return result;
}

// The largest distance of a vertex that a triangle uses.
double max_over_vertices(const Mesh& mesh, const Frame& frame, const Surface& to) {
  std::vector<bool> used(mesh.vertex_count());
  for (const Triangle& triangle : mesh.triangles) {
    for (VertexId v : triangle) used[index_of(v)] = true;
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, mesh.vertex_count(), kGrain), 0.0,
      [&](const auto& range, double largest) {
        Surface::Scratch scratch;
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
          if (!used[v]) continue;
          const Vec3d p = frame.to_frame(mesh.positions[v]);
          largest = std::max(largest, to.nearest(p, nullptr, 0, scratch).distance);
        }
        return largest;
      },
      [](double x, double y) { return std::max(x, y); });
}

Spread spread_of(const OneWay& way, double scale) {
  Spread spread{.max = way.max / scale};
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

Comparison compare(const Mesh& a, const Mesh& b, const CompareOptions& options) {
  const Frame frame = common_frame(a, b);
  const double tie = kTie * frame.diagonal * frame.scale;
  const Surface surface_a(a, frame), surface_b(b, frame);

  OneWay a_to_b = measure_samples(surface_a, surface_b, options, tie);
  OneWay b_to_a = measure_samples(surface_b, surface_a, options, tie);
  a_to_b.max = std::max(a_to_b.max, max_over_vertices(a, frame, surface_b));
  b_to_a.max = std::max(b_to_a.max, max_over_vertices(b, frame, surface_a));

  Comparison result;
  result.diagonal = frame.diagonal;
  result.samples = options.samples;
  result.distance.a_to_b = spread_of(a_to_b, frame.scale);
  result.distance.b_to_a = spread_of(b_to_a, frame.scale);

  std::vector<double>& deviation = a_to_b.deviation;
  deviation.insert(deviation.end(), b_to_a.deviation.begin(), b_to_a.deviation.end());
  if (deviation.empty()) return result;
  double sum = 0;
  for (double d : deviation) sum += d;
  result.normal_deviation.mean = degrees(sum / double(deviation.size()));
  std::sort(deviation.begin(), deviation.end());
  result.normal_deviation.p95 = degrees(deviation[(deviation.size() - 1) * 95 / 100]);
  result.normal_deviation.max = degrees(deviation.back());
  return result;
}

// Runs `work` on at most `threads` threads.
template <typename Work>
void run_on(int threads, const Work& work) {
  // More than TBB allows would make it print a warning.
  const std::size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  tbb::task_arena arena(threads > 0 ? std::min(threads, int(allowed)) : tbb::task_arena::automatic);
  arena.execute(work);
}

}  // namespace

Comparison compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options) {
  CREASE_ASSERT(a.triangle_count() > 0 && b.triangle_count() > 0);
  CREASE_ASSERT(a.normals() != nullptr && b.normals() != nullptr);
  Comparison result;
  run_on(options.threads, [&] { result = compare(a, b, options); });
  return result;
}

std::vector<float> distances_to(const Mesh& surface, std::span<const Vec3d> points, int threads) {
  CREASE_ASSERT(surface.triangle_count() > 0 && surface.normals() != nullptr);
  std::vector<float> distance_of_point(points.size());
  run_on(threads, [&] {
    const Frame frame = common_frame(surface, surface);
    const Surface to(surface, frame);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), kGrain),
                      [&](const auto& range) {
                        Surface::Scratch scratch;
                        for (std::size_t i = range.begin(); i < range.end(); ++i) {
                          const Vec3d p = frame.to_frame(points[i]);
                          const Nearest nearest = to.nearest(p, nullptr, 0, scratch);
                          distance_of_point[i] = float(nearest.distance / frame.scale);
                        }
                      });
  });
  return distance_of_point;
}

}  // namespace crease

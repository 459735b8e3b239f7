#include "crease/compare.h"

#include "base/assert.h"
#include "measure/sample.h"
#include "measure/surface.h"
#include "parallel/parallel.h"
#include "parallel/shared_progress.h"

#include <algorithm>
#include <mutex>
#include <vector>

namespace crease {

namespace {

// Two triangles count as equally near when their distances differ by less than this share of the
// diagonal: a sample on a hard edge sees both sides of it.
constexpr double kTie = 1e-5;
constexpr std::size_t kGrain = 512;

// So many points are looked for at a time; in between a thread asks whether to go on.
constexpr std::size_t kAtATime = 64;

// Calls look(i) for points i of a range, until the work is to stop.
template <typename Look>
void look_for_each(std::size_t begin, std::size_t end, SharedProgress& progress, Look look) {
  while (begin < end && !progress.stopped()) {
    const std::size_t next = std::min(end, begin + kAtATime);
    for (std::size_t i = begin; i < next; ++i) look(i);
    progress.advance(next - begin);
    begin = next;
  }
}

struct OneWay {
  std::vector<double> distance;   // frame units, per sample
  std::vector<double> deviation;  // radians, per sample
  double max = 0;                 // frame units, vertices included
};

// Per sample into arrays of its own, so that sums do not depend on how threads share the work.
OneWay measure_samples(const Surface& from, const Surface& to, const CompareOptions& options,
                       double tie, SharedProgress& progress) {
  OneWay result;
  result.distance.resize(options.samples);
  result.deviation.resize(options.samples);
  const Sampler sampler(from, options.samples, options.seed);
  parallel_ranges(options.samples, kGrain, [&](std::size_t begin, std::size_t end) {
    Surface::Scratch scratch;
    look_for_each(begin, end, progress, [&](std::size_t i) {
      const SurfacePoint sample = sampler(i);
      Vec3d p;
      for (std::size_t c = 0; c < 3; ++c) {
        p += from.corner(sample.triangle, c) * sample.weights[c];
      }
      const Vec3d normal = from.normal(sample.triangle, sample.weights);
      const Nearest nearest = to.nearest(p, &normal, tie, scratch);
      result.distance[i] = nearest.distance;
      result.deviation[i] = nearest.deviation_rad;
    });
  });
  for (double d : result.distance) result.max = std::max(result.max, d);
  return result;
}

// The largest distance of a vertex that a triangle uses.
double max_over_vertices(const Mesh& mesh, const Frame& frame, const Surface& to,
                         SharedProgress& progress) {
  std::vector<bool> used(mesh.vertex_count());
  for (const Triangle& triangle : mesh.triangles) {
    for (VertexId v : triangle) used[index_of(v)] = true;
  }
  double largest = 0;
  std::mutex join;
  parallel_ranges(mesh.vertex_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    Surface::Scratch scratch;
    double own = 0;
    look_for_each(begin, end, progress, [&](std::size_t v) {
      if (!used[v]) return;
      const Vec3d p = frame.to_frame(mesh.positions[v]);
      own = std::max(own, to.nearest(p, nullptr, 0, scratch).distance);
    });
    const std::lock_guard<std::mutex> lock(join);
    largest = std::max(largest, own);
  });
  return largest;
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

Result<Comparison> compare(const Mesh& a, const Mesh& b, const CompareOptions& options) {
  const Frame frame = common_frame(a, b);
  const double tie = kTie * frame.diagonal * frame.scale;
  const Surface surface_a(a, frame), surface_b(b, frame);

  SharedProgress progress(options.progress, "compare",
                          2 * options.samples + a.vertex_count() + b.vertex_count());
  OneWay a_to_b = measure_samples(surface_a, surface_b, options, tie, progress);
  OneWay b_to_a = measure_samples(surface_b, surface_a, options, tie, progress);
  a_to_b.max = std::max(a_to_b.max, max_over_vertices(a, frame, surface_b, progress));
  b_to_a.max = std::max(b_to_a.max, max_over_vertices(b, frame, surface_a, progress));
  if (progress.stopped()) return fail(Error::Interrupted, "compare: interrupted");

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

}  // namespace

Result<Comparison> compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options) {
  CREASE_ASSERT(a.triangle_count() > 0 && b.triangle_count() > 0);
  CREASE_ASSERT(a.normals() != nullptr && b.normals() != nullptr);
  return run_on(options.threads, [&] { return compare(a, b, options); });
}

std::vector<float> distances_to(const Mesh& surface, std::span<const Vec3d> points, int threads) {
  CREASE_ASSERT(surface.triangle_count() > 0 && surface.normals() != nullptr);
  return run_on(threads, [&] {
    const Frame frame = common_frame(surface, surface);
    const Surface to(surface, frame);
    std::vector<float> distance_of_point(points.size());
    parallel_ranges(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
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

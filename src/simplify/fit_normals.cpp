#include "simplify/fit_normals.h"

#include "base/mixed.h"
#include "base/wide.h"
#include "hierarchy/eight_triangles.h"
#include "parallel/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace crease::simplification {

namespace {

// As many samples as the input has triangles, but no more than so many for each that is left; with
// fewer than the least, normals fit what was sampled rather than the surface.
constexpr std::size_t kMostSamples = 8, kLeastSamples = 6;
constexpr double kMostOfTriangle = 64;

constexpr int kMostVertices = 4;  // that a sample is looked for around
constexpr float kNear = 0.05f;    // a chord: above it differences count by their size, not squared
constexpr double kOwn = 0.02;     // what the present value counts beside the samples
constexpr int kSweeps = 4;
constexpr double kDamping = 0.8;  // the eigenvalues of such equations lie between 1/2 and 2
constexpr std::size_t kTogether = 1 << 15;  // samples
constexpr std::size_t kChunk = 1024;
// At eight triangles each, around one vertex and of one batch: else fans take the square of time.
constexpr std::size_t kMostLooks = 1 << 17;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <typename Body>
void for_chunks(std::size_t count, const Body& body) {
  parallel_for((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    body(chunk * kChunk, std::min(count, (chunk + 1) * kChunk));
  });
}

Vec3f as_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

struct Nearest {
  double squared = 0, second = 0, third = 0;  // the shares of b and c
};

// The point of a triangle nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Nearest nearest_in(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto at = [&](double second, double third) {
    const Vec3d off = ap - ab * second - ac * third;
    return Nearest{dot(off, off), second, third};
  };
  const double b_of_a = dot(ab, ap), c_of_a = dot(ac, ap), b_of_b = dot(ab, bp);
  const double c_of_b = dot(ac, bp), b_of_c = dot(ab, cp), c_of_c = dot(ac, cp);
  if (b_of_a <= 0 && c_of_a <= 0) return at(0, 0);
  if (b_of_b >= 0 && c_of_b <= b_of_b) return at(1, 0);
  if (c_of_c >= 0 && b_of_c <= c_of_c) return at(0, 1);
  const double third = b_of_a * c_of_b - b_of_b * c_of_a;
  if (third <= 0 && b_of_a >= 0 && b_of_b <= 0) return at(b_of_a / (b_of_a - b_of_b), 0);
  const double second = b_of_c * c_of_a - b_of_a * c_of_c;
  if (second <= 0 && c_of_a >= 0 && c_of_c <= 0) return at(0, c_of_a / (c_of_a - c_of_c));
  const double first = b_of_b * c_of_c - b_of_c * c_of_b;
  const double to_c = c_of_b - b_of_b, to_b = b_of_c - c_of_c;
  if (first <= 0 && to_c >= 0 && to_b >= 0) return at(to_b / (to_c + to_b), to_c / (to_c + to_b));
  const double sum = first + second + third;
  return sum > 0 ? at(second / sum, third / sum) : at(0, 0);
}

}  // namespace

// The triangles around a vertex.
struct NormalFit::Fan {
  struct Shown {
    EightTriangles::Lanes of[3];  // about the normals
  };
  std::uint32_t vertex = kNone;
  Vec3d origin;
  std::span<const std::uint32_t> corners;
  std::vector<EightTriangles> triangles;
  std::vector<Shown> shown;
};

NormalFit::NormalFit(const Mesh& input, const Grid& grid, WorkMesh& work)
    : input_(input), origin_(grid.origin), per_step_(1 / grid.step), work_(work) {
  for (WorkLayer& layer : work.layers) {
    if (!layer_ && layer.is_normal && layer.is_direction && layer.dimension == 3) layer_ = &layer;
  }
  if (!layer_) return;
  input_values_ = layer_->source->value_count();
  now_at_.resize(work.positions.size());
  std::iota(now_at_.begin(), now_at_.end(), 0u);
  input_area_.resize(input.triangle_count());
  for_chunks(input_area_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto at = [&](std::size_t c) {
        return position(static_cast<std::uint32_t>(index_of(input.triangles[t][c])));
      };
      input_area_[t] = static_cast<float>(0.5 * length(cross(at(1) - at(0), at(2) - at(0))));
    }
  });
  for (std::uint32_t t = 0; t < input_area_.size(); ++t) {
    area_ += double(input_area_[t]);
    if (input_area_[t] > 0) candidates_.push_back(t);
  }
}

void NormalFit::find_corners() {
  place_of_vertex_.resize(work_.positions.size());
  vertices_.clear();
  first_corner_.assign(1, 0);
  for (const std::uint32_t t : work_.live) {
    for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
      const std::uint32_t v = work_.vertex_of_corner[corner];
      std::uint32_t& place = place_of_vertex_[v];
      if (!is_live(v)) {
        place = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(v);
        first_corner_.push_back(0);
      }
      ++first_corner_[place + 1];
    }
  }
  std::partial_sum(first_corner_.begin(), first_corner_.end(), first_corner_.begin());
  corners_.resize(first_corner_.back());
  for (const std::uint32_t t : work_.live) {
    for (std::uint32_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
      corners_[first_corner_[place_of_vertex_[work_.vertex_of_corner[corner]]]++] = corner;
    }
  }
  std::copy_backward(first_corner_.begin(), first_corner_.end() - 1, first_corner_.end());
  first_corner_[0] = 0;
}

std::span<const std::uint32_t> NormalFit::corners_of(std::uint32_t vertex) const {
  const std::uint32_t* first = &first_corner_[place_of_vertex_[vertex]];
  return std::span(corners_).subspan(first[0], first[1] - first[0]);
}

NormalFit::Sample NormalFit::sample_of(std::uint32_t triangle, std::uint32_t place,
                                       double area) const {
  double shares[] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  if (place > 0) {  // spread evenly by two irrational steps (Roberts)
    double u = 1.0 / 3 + 0.7548776662466927 * place, v = 1.0 / 3 + 0.5698402909980532 * place;
    u -= std::floor(u);
    v -= std::floor(v);
    const bool is_beyond = u + v > 1;
    shares[1] = is_beyond ? 1 - u : u;
    shares[2] = is_beyond ? 1 - v : v;
    shares[0] = 1 - shares[1] - shares[2];
  }
  Sample sample;
  Vec3d point, normal;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3d& p = input_.positions[index_of(input_.triangles[triangle][c])];
    point = point + (p - origin_) * (per_step_ * shares[c]);
    const float* n = value_of(index_of(layer_->source->of_corner[3 * std::size_t(triangle) + c]));
    normal = normal + Vec3d{double(n[0]), double(n[1]), double(n[2])} * shares[c];
  }
  const double size = length(normal);
  sample.point = as_float(point);
  sample.normal = as_float(normal * (size > 0.1 ? 1 / size : 0));
  sample.area = static_cast<float>(area);
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : input_.triangles[triangle]) {
    const std::uint32_t now = now_at_[index_of(v)];
    if (!is_live(now)) continue;
    const Vec3d off = position(now) - point;
    const double squared = dot(off, off);
    if (squared >= least) continue;
    least = squared;
    sample.vertex = now;
  }
  return sample;
}

// From this candidate on; returns where the next ones begin. A triangle has as many as its area is
// worth, and of those that are not worth one only this part is among the candidates.
std::size_t NormalFit::choose_samples(std::size_t from, double share, double part) {
  struct Chosen {
    std::uint32_t triangle, place;
    double area;
  };
  std::vector<Chosen> chosen;
  for (; from < candidates_.size() && chosen.size() < kTogether; ++from) {
    const std::uint32_t t = candidates_[from];
    const double area = double(input_area_[t]);
    const double points =
        area < share ? 1 : std::clamp(std::ceil(area / share), 1.0, kMostOfTriangle);
    const double each = area < share ? area / part : area / points;
    for (std::uint32_t i = 0; i < points; ++i) chosen.push_back({t, i, each});
    for (const VertexId v : input_.triangles[t]) {
      std::uint32_t& now = now_at_[index_of(v)];
      while (now_at_[now] != now) now = now_at_[now] = now_at_[now_at_[now]];
    }
  }
  samples_.resize(chosen.size());
  for_chunks(chosen.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      samples_[i] = sample_of(chosen[i].triangle, chosen[i].place, chosen[i].area);
    }
  });
  return from;
}

void NormalFit::sort_by_vertex(std::vector<std::uint32_t>& samples) {
  const auto place_of = [&](std::uint32_t s) { return place_of_vertex_[samples_[s].vertex]; };
  first_sample_.assign(vertices_.size() + 1, 0);
  for (const std::uint32_t s : samples) ++first_sample_[place_of(s) + 1];
  std::partial_sum(first_sample_.begin(), first_sample_.end(), first_sample_.begin());
  std::vector<std::uint32_t> sorted(samples.size());
  for (const std::uint32_t s : samples) sorted[first_sample_[place_of(s)]++] = s;
  std::copy_backward(first_sample_.begin(), first_sample_.end() - 1, first_sample_.end());
  first_sample_[0] = 0;
  samples.swap(sorted);
}

CREASE_WIDE void NormalFit::load_fan(std::uint32_t vertex, Fan& fan) const {
  constexpr std::size_t kLanes = EightTriangles::kLanes;
  fan.vertex = vertex;
  fan.origin = position(vertex);
  fan.corners = corners_of(vertex);
  const std::size_t blocks = (fan.corners.size() + kLanes - 1) / kLanes;
  fan.triangles.resize(blocks);
  fan.shown.resize(blocks);
  for (std::size_t i = 0; i < fan.corners.size(); ++i) {
    const std::size_t t = fan.corners[i] / 3, c = fan.corners[i] % 3;
    const auto at = [&](std::size_t corner) {
      return position(work_.vertex_of_corner[3 * t + corner % 3]) - fan.origin;
    };
    fan.triangles[i / kLanes].put(i % kLanes, at(c + 1), at(c + 2));
    const float *x = value_at(3 * t), *y = value_at(3 * t + 1), *z = value_at(3 * t + 2);
    for (int k = 0; k < 3; ++k) {
      const float sum = x[k] + y[k] + z[k];
      EightTriangles::Lanes& lanes = fan.shown[i / kLanes].of[k];
      if (i % kLanes == 0) lanes = EightTriangles::Lanes{} + sum;
      lanes[i % kLanes] = sum;
    }
  }
  for (EightTriangles& eight : fan.triangles) eight.prepare();
}

// Never in a triangle that shows the other side.
CREASE_WIDE void NormalFit::look_around(const Fan& fan, Sample& sample) const {
  using Lanes = EightTriangles::Lanes;
  sample.goes_on = false;
  const Vec3d off =
      Vec3d{double(sample.point.x), double(sample.point.y), double(sample.point.z)} - fan.origin;
  const Vec3f from = as_float(off);
  const Lanes p[] = {Lanes{} + from.x, Lanes{} + from.y, Lanes{} + from.z};
  float nearest = sample.triangle == kNone ? kInfinity : sample.squared;
  std::size_t found = kNone;
  for (std::size_t b = 0; b < fan.triangles.size(); ++b) {
    Lanes squared;
    fan.triangles[b].measure(p, squared);
    const Lanes* shown = fan.shown[b].of;
    const Lanes facing =
        shown[0] * sample.normal.x + shown[1] * sample.normal.y + shown[2] * sample.normal.z;
    squared = facing > 0 ? squared : Lanes{} + kInfinity;
    for (std::size_t lane = 0; lane < EightTriangles::kLanes; ++lane) {
      if (squared[lane] >= nearest) continue;
      nearest = squared[lane];
      found = b * EightTriangles::kLanes + lane;
    }
  }
  if (found == kNone) return;
  const std::uint32_t t = fan.corners[found] / 3;
  const std::uint32_t* v = &work_.vertex_of_corner[3 * std::size_t(t)];
  const Nearest exact = nearest_in(off, position(v[0]) - fan.origin, position(v[1]) - fan.origin,
                                   position(v[2]) - fan.origin);
  sample.triangle = t;
  sample.squared = nearest;
  sample.second = static_cast<float>(exact.second);
  sample.third = static_cast<float>(exact.third);
  // On the rim of the triangles around the vertex: what is beyond may be nearer.
  const double share[] = {1 - exact.second - exact.third, exact.second, exact.third};
  const std::size_t own = fan.corners[found] % 3, next = (own + 1) % 3, previous = (own + 2) % 3;
  if (share[own] > 0) return;
  sample.vertex = v[share[next] > share[previous] ? next : previous];
  sample.goes_on = true;
}

void NormalFit::find_triangles() {
  std::vector<std::uint32_t> left;
  for (std::uint32_t s = 0; s < samples_.size(); ++s) {
    if (samples_[s].vertex != kNone) left.push_back(s);  // else its part is gone
  }
  for (int round = 0; round < kMostVertices && !left.empty(); ++round) {
    sort_by_vertex(left);
    for_chunks(vertices_.size(), [&](std::size_t begin, std::size_t end) {
      Fan fan;
      for (std::size_t place = begin; place < end; ++place) {
        if (first_sample_[place] == first_sample_[place + 1]) continue;
        load_fan(vertices_[place], fan);
        const std::size_t own = first_sample_[place + 1] - first_sample_[place];
        const std::size_t most =
            std::max<std::size_t>(1, kMostLooks / std::max<std::size_t>(1, fan.triangles.size()));
        const std::size_t stride = (own + most - 1) / most;
        for (std::size_t i = 0; i < own; ++i) {
          Sample& sample = samples_[left[first_sample_[place] + i]];
          sample.goes_on = false;
          if (i % stride == 0) look_around(fan, sample);
        }
      }
    });
    std::erase_if(left, [&](std::uint32_t s) { return !samples_[s].goes_on; });
  }
}

void NormalFit::add(const Sample& sample) {
  if (sample.triangle == kNone || work_.derived[sample.triangle]) return;
  const std::size_t t = sample.triangle;
  const float share[] = {1 - sample.second - sample.third, sample.second, sample.third};
  float shown[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const float* value = value_at(3 * t + i);
    for (int k = 0; k < 3; ++k) shown[k] += share[i] * value[k];
  }
  const Vec3f& n = sample.normal;
  const float size = std::sqrt(shown[0] * shown[0] + shown[1] * shown[1] + shown[2] * shown[2]);
  if (!(size > 0)) return;
  // Of unit vectors: the chord between them.
  const float cosine = (shown[0] * n.x + shown[1] * n.y + shown[2] * n.z) / size;
  const float weight = sample.area / std::max(kNear, std::sqrt(std::max(0.0f, 2 - 2 * cosine)));
  Equations& e = equations_[place_of_triangle_[t]];
  for (std::size_t i = 0; i < 3; ++i) {
    e.own[i] += weight * share[i] * share[i];
    e.across[i] += weight * share[(i + 1) % 3] * share[(i + 2) % 3];
    // What is interpolated between unit vectors is shorter, wherever it points.
    const float w = weight * share[i] * size;
    e.sum[i] = {e.sum[i].x + w * n.x, e.sum[i].y + w * n.y, e.sum[i].z + w * n.z};
  }
}

void NormalFit::fit(std::size_t first_value) {
  if (!layer_ || !(area_ > 0)) return;
  const std::size_t count = input_.triangle_count(), live = work_.live.size();
  if (layer_->value_count() <= first_value || count < kLeastSamples * live) return;
  const std::size_t wanted = std::min(count, kMostSamples * live);
  const double share = area_ / double(wanted), part = double(wanted) / double(count);
  // Fewer with every pass, of those that there were.
  std::erase_if(candidates_, [&](std::uint32_t t) {
    return double(input_area_[t]) < share && double(mixed(t)) >= part * 0x1p32;
  });
  find_corners();
  place_of_triangle_.resize(count);
  for (std::uint32_t i = 0; i < live; ++i) place_of_triangle_[work_.live[i]] = i;
  equations_.assign(live, {});
  for (std::size_t from = 0; from < candidates_.size();) {
    from = choose_samples(from, share, part);
    find_triangles();
    for (const Sample& sample : samples_) add(sample);
  }
  samples_ = {};
  solve(first_value);
  equations_ = {};
}

// What it should be while all others are what they are.
Vec3d NormalFit::better_value(std::uint32_t vertex, std::uint32_t id, const float* start) const {
  const float* now = value_of(id);
  const Vec3d present{double(now[0]), double(now[1]), double(now[2])};
  double own = 0, weight = 0, sum[3] = {};
  for (const std::uint32_t corner : corners_of(vertex)) {
    if (layer_->of_corner[corner] != id) continue;
    const std::size_t t = corner / 3, c = corner % 3, n = (c + 1) % 3, p = (c + 2) % 3;
    const Equations& e = equations_[place_of_triangle_[t]];
    own += double(e.own[c]);
    weight += double(e.own[c]) + double(e.across[n]) + double(e.across[p]);
    const float *next = value_at(3 * t + n), *previous = value_at(3 * t + p);
    const float right[] = {e.sum[c].x, e.sum[c].y, e.sum[c].z};
    for (int k = 0; k < 3; ++k) {
      sum[k] += double(right[k]) - double(e.across[p]) * double(next[k]) -
                double(e.across[n]) * double(previous[k]);
    }
  }
  if (!(own > 0)) return present;
  Vec3d best;
  for (int k = 0; k < 3; ++k) {
    best[k] = (sum[k] + kOwn * weight * double(start[k])) / (own + kOwn * weight);
  }
  const Vec3d value = present + (best - present) * kDamping;
  const double size = length(value);
  return size > 1e-3 ? value * (1 / size) : present;
}

void NormalFit::solve(std::size_t first_value) {
  const std::size_t unknowns = layer_->value_count() - first_value;
  std::vector<std::uint32_t> vertex_of(unknowns, kNone);
  for (const std::uint32_t t : work_.live) {
    for (std::size_t corner = 3 * std::size_t(t); corner < 3 * std::size_t(t) + 3; ++corner) {
      const std::uint32_t id = layer_->of_corner[corner];
      if (id >= first_value) vertex_of[id - first_value] = work_.vertex_of_corner[corner];
    }
  }
  const std::span<float> values =
      std::span(layer_->new_values).subspan(3 * (first_value - input_values_));
  const std::vector<float> start(values.begin(), values.end());
  std::vector<float> next(start);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for_chunks(unknowns, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (vertex_of[i] == kNone) continue;  // contracted again in the same pass
        const auto id = static_cast<std::uint32_t>(first_value + i);
        const Vec3f value = as_float(better_value(vertex_of[i], id, &start[3 * i]));
        next[3 * i] = value.x;
        next[3 * i + 1] = value.y;
        next[3 * i + 2] = value.z;
      }
    });
    std::copy(next.begin(), next.end(), values.begin());
  }
}

}  // namespace crease::simplification

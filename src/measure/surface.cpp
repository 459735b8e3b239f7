#include "measure/surface.h"

#include "base/assert.h"
#include "measure/closest_point.h"
#include "mesh/strays.h"
#include "parallel/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace crease {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kInfinityf = std::numeric_limits<float>::infinity();

// Embree works in floats. Boxes are rounded outwards; a query point moves by less than 2^-24 of its
// coordinates, or of 1, an axis, and the squared distance to a box is right to a few units in the
// last place. A search that reaches this much further misses no triangle.
constexpr double kReach = 1e-6;

double reach_at(const Vec3d& p) {
  return kReach * std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

struct Box {
  Vec3d low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};

  void include(const Vec3d& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
};

// Of the surface: vertices that no triangle uses do not count.
Box bounding_box(const Mesh& mesh) {
  Box box;
  for (const Triangle& triangle : mesh.triangles) {
    for (VertexId v : triangle) box.include(mesh.positions[index_of(v)]);
  }
  return box;
}

// A city with a triangle at the origin of its coordinates, 10,000 times its size away, is measured
// as without it.
Box box_of_most(const Mesh& mesh, const Box& whole) {
  const std::optional<PointBox> most = box_without_strays(mesh);
  if (!most) return whole;
  Box box;
  for (int i = 0; i < 3; ++i) {
    box.low[i] = std::max(whole.low[i], most->low[i]);
    box.high[i] = std::min(whole.high[i], most->low[i] + most->size[i]);
    if (!(box.low[i] <= box.high[i])) return whole;  // all but strays are in no triangle
  }
  return box;
}

}  // namespace

Frame common_frame(const Mesh& a, const Mesh& b) {
  const Box box_a = bounding_box(a), box_b = bounding_box(b);
  const Box most_a = box_of_most(a, box_a), most_b = box_of_most(b, box_b);
  Frame frame;
  frame.origin = most_a.low + (most_a.high - most_a.low) * 0.5;
  frame.diagonal = length(box_a.high - box_a.low);
  frame.size = length(most_a.high - most_a.low);
  frame.larger = std::max(frame.diagonal, length(box_b.high - box_b.low));
  Vec3d gap;
  for (int i = 0; i < 3; ++i) {
    gap[i] = std::max({box_a.low[i] - box_b.high[i], box_b.low[i] - box_a.high[i], 0.0});
  }
  frame.gap = length(gap);
  double reach = 0;
  for (const Vec3d& corner : {most_a.low, most_a.high, most_b.low, most_b.high}) {
    const Vec3d d = corner - frame.origin;
    reach = std::max({reach, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  int exponent = 0;
  std::frexp(reach, &exponent);
  frame.scale = reach > 0 ? std::ldexp(1.0, -exponent) : 1.0;
  return frame;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  constexpr double kRounding = 1e-12;  // of doubles that went ways of their own
  const double angle = std::atan2(length(cross(a, b)), dot(a, b));
  return angle < kRounding ? 0 : angle;
}

struct Surface::Query {
  const Surface& surface;
  Vec3d p;
  double tie;
  Scratch& scratch;
  double best = kInfinity;

  float radius() const {
    return best < kInfinity ? float((best + tie) * (1 + kReach) + reach_at(p)) : kInfinityf;
  }
};

Surface::Surface(const Mesh& mesh, const Frame& frame) : mesh_(mesh), normals_(*mesh.normals()) {
  positions_.reserve(mesh.vertex_count());
  for (const Vec3d& p : mesh.positions) positions_.push_back(frame.to_frame(p));

  pieces_ = pieces_of(mesh.triangle_count(), [this](std::size_t t) {
    return TriangleCorners{corner(t, 0), corner(t, 1), corner(t, 2)};
  });
  const std::size_t count = pieces_.empty() ? mesh.triangle_count() : pieces_.size();
  device_.reset(rtcNewDevice(nullptr));
  CREASE_ASSERT(device_ != nullptr);
  scene_.reset(rtcNewScene(device_.get()));
  // A geometry of our own instead of Embree's triangles: their vertices would be floats, and each
  // would be stored once more.
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  const auto write_bounds = [this](std::size_t primitive, RTCBounds* bounds) {
    *bounds = bounds_of(primitive);
  };
  const parallel::Fork bounds(write_bounds);  // Embree asks from tasks of its own, in commits only
  using Bounds = decltype(bounds);
  rtcSetGeometryUserData(geometry, const_cast<std::remove_const_t<Bounds>*>(&bounds));
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* arguments) {
        static_cast<Bounds*>(arguments->geometryUserPtr)
            ->run(arguments->primID, arguments->bounds_o);
      },
      nullptr);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcJoinCommitScene(scene_.get());
  CREASE_ASSERT(rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE);
}

RTCBounds Surface::bounds_of(std::size_t primitive) const {
  const TrianglePiece piece =
      pieces_.empty() ? TrianglePiece{static_cast<std::uint32_t>(primitive)} : pieces_[primitive];
  const PieceOutline outline = outline_of(
      {corner(piece.triangle, 0), corner(piece.triangle, 1), corner(piece.triangle, 2)}, piece);
  Box box;
  for (std::size_t i = 0; i < outline.count; ++i) box.include(outline.points[i]);
  const auto below = [](double x) { return std::nextafter(float(x), -kInfinityf); };
  const auto above = [](double x) { return std::nextafter(float(x), kInfinityf); };
  RTCBounds bounds{};
  bounds.lower_x = below(box.low.x);
  bounds.lower_y = below(box.low.y);
  bounds.lower_z = below(box.low.z);
  bounds.upper_x = above(box.high.x);
  bounds.upper_y = above(box.high.y);
  bounds.upper_z = above(box.high.z);
  return bounds;
}

Vec3d Surface::normal(std::size_t triangle, const std::array<double, 3>& weights) const {
  Vec3d sum;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<const float> n = normals_.value(normals_.of_corner[3 * triangle + c]);
    sum += normalized(Vec3d{n[0], n[1], n[2]}) * weights[c];
  }
  constexpr double kCancelled = 1e-6;
  if (length(sum) > kCancelled) return normalized(sum);
  const Vec3d a = corner(triangle, 0);
  return normalized(cross(corner(triangle, 1) - a, corner(triangle, 2) - a));
}

void Surface::visit(Query& query, std::uint32_t triangle) const {
  const ClosestPoint found =
      closest_point(query.p, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
  const double distance = std::sqrt(found.squared_distance);
  if (distance > query.best + query.tie) return;
  query.best = std::min(query.best, distance);
  query.scratch.candidates.push_back({distance, triangle, found.weights});
}

bool Surface::visit_primitive(RTCPointQueryFunctionArguments* arguments) {
  Query& query = *static_cast<Query*>(arguments->userPtr);
  const double before = query.best;
  const std::vector<TrianglePiece>& pieces = query.surface.pieces_;
  const std::uint32_t triangle =
      pieces.empty() ? arguments->primID : pieces[arguments->primID].triangle;
  if (triangle == query.scratch.last_triangle) return false;  // visited first of all
  query.surface.visit(query, triangle);
  if (query.best == before) return false;
  arguments->query->radius = query.radius();
  return true;
}

void Surface::Scratch::keep_one_each() {
  std::ranges::sort(candidates, {}, &Candidate::triangle);
  const auto same = [](const Candidate& a, const Candidate& b) { return a.triangle == b.triangle; };
  candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
}

Nearest Surface::nearest(const Vec3d& p, const Vec3d* normal, double tie, Scratch& scratch) const {
  scratch.candidates.clear();
  Query query{.surface = *this, .p = p, .tie = tie, .scratch = scratch};
  if (scratch.last_triangle != kNone) visit(query, scratch.last_triangle);

  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery search{
      .x = float(p.x), .y = float(p.y), .z = float(p.z), .time = 0, .radius = query.radius()};
  rtcPointQuery(scene_.get(), &search, &context, visit_primitive, &query);

  Nearest nearest{.distance = query.best};
  std::erase_if(scratch.candidates, [&](const Scratch::Candidate& candidate) {
    return candidate.distance > query.best + tie;
  });
  if (!pieces_.empty()) scratch.keep_one_each();
  double least = kInfinity;
  for (const Scratch::Candidate& candidate : scratch.candidates) {
    if (candidate.distance == query.best) {
      nearest.triangle = std::min(nearest.triangle, candidate.triangle);
    }
    if (normal == nullptr) continue;
    least = std::min(least,
                     angle_between(*normal, this->normal(candidate.triangle, candidate.weights)));
  }
  scratch.last_triangle = nearest.triangle;
  if (normal != nullptr) nearest.deviation_rad = least;
  return nearest;
}

}  // namespace crease

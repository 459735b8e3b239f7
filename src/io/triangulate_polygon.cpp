#include "io/triangulate_polygon.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

namespace crease {
namespace {

using Index = std::uint32_t;

// A point of the projection, on the grid. 2^29 steps a side keep every orientation within 61 bits.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  bool operator==(const GridPoint&) const = default;
};
constexpr double kGridSteps = double(1 << 29);

// Twice the signed area of abc: > 0 if counter-clockwise.
std::int64_t orient(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// True if p, known to be collinear with ab, lies between them and on neither.
bool strictly_between(const GridPoint& a, const GridPoint& b, const GridPoint& p) {
  const std::int64_t along = (p.x - a.x) * (p.x - b.x) + (p.y - a.y) * (p.y - b.y);
  return along < 0;
}

bool opposite(std::int64_t a, std::int64_t b) {
  return (a < 0 && b > 0) || (a > 0 && b < 0);
}

// The rings as linked lists of nodes; bridges make two nodes of one point.
struct Rings {
  std::vector<GridPoint> at;  // per node
  std::vector<Index> point;   // per node: the caller's point
  std::vector<Index> next, previous;

  std::int64_t turn(Index n) const { return orient(at[previous[n]], at[n], at[next[n]]); }
  void link(Index a, Index b) {
    next[a] = b;
    previous[b] = a;
  }
  Index copy(Index n) {
    at.push_back(at[n]);
    point.push_back(point[n]);
    next.push_back(n);
    previous.push_back(n);
    return static_cast<Index>(at.size() - 1);
  }
  void remove(Index n) { link(previous[n], next[n]); }
};

// True if the direction from node n to `target` goes into the inside of n's ring (O'Rourke's
// in-cone test; the inside is on the left).
bool goes_inside(const Rings& rings, Index n, const GridPoint& target) {
  const GridPoint& a = rings.at[rings.previous[n]];
  const GridPoint& o = rings.at[n];
  const GridPoint& b = rings.at[rings.next[n]];
  if (orient(a, o, b) >= 0) return orient(o, target, a) > 0 && orient(target, o, b) > 0;
  return !(orient(o, target, b) >= 0 && orient(target, o, a) >= 0);
}

// True if the open segment pq meets no edge and no vertex of any ring.
bool sees(const Rings& rings, const GridPoint& p, const GridPoint& q) {
  for (Index n = 0; n < rings.at.size(); ++n) {
    const GridPoint& u = rings.at[n];
    const GridPoint& v = rings.at[rings.next[n]];
    const std::int64_t at_u = orient(p, q, u);
    if (at_u == 0 && strictly_between(p, q, u)) return false;
    if (!opposite(at_u, orient(p, q, v))) continue;
    if (opposite(orient(u, v, p), orient(u, v, q))) return false;
  }
  return true;
}

std::vector<Index> nodes_of_ring(const Rings& rings, Index start) {
  std::vector<Index> nodes;
  Index n = start;
  do {
    nodes.push_back(n);
    n = rings.next[n];
  } while (n != start);
  return nodes;
}

// Makes one ring of two: outer .. `to`, `from`, around the hole, `from` again, `to` again .. outer.
void add_bridge(Rings& rings, Index from, Index to) {
  const Index after = rings.next[to];
  const Index last = rings.previous[from];
  const Index from_again = rings.copy(from);
  const Index to_again = rings.copy(to);
  rings.link(to, from);
  rings.link(last, from_again);
  rings.link(from_again, to_again);
  rings.link(to_again, after);
}

// A hole that touches the outer ring in a vertex is joined there: a bridge from elsewhere could run
// along the hole's own edge. The cone that the hole's next point lies in tells which node of the
// outer ring, if there are several.
bool bridge_where_touching(Rings& rings, const std::vector<Index>& outer_nodes, Index hole) {
  const auto key = [&](Index n) { return std::pair(rings.at[n].x, rings.at[n].y); };
  std::vector<Index> hole_nodes = nodes_of_ring(rings, hole);
  std::ranges::sort(hole_nodes, {}, key);
  for (Index to : outer_nodes) {
    auto found = std::ranges::lower_bound(hole_nodes, key(to), {}, key);
    for (; found != hole_nodes.end() && key(*found) == key(to); ++found) {
      const Index from = *found;
      if (!goes_inside(rings, to, rings.at[rings.next[from]])) continue;
      add_bridge(rings, from, to);
      return true;
    }
  }
  return false;
}

// Joins the ring of `hole` to the ring of `outer` by a bridge from `hole`, its leftmost node, to
// the nearest node that it sees. False if there is none, or the budget of steps ran out: then a
// bridge is laid as it comes.
bool bridge_hole(Rings& rings, Index outer, Index hole, std::int64_t& budget) {
  if (budget < 0) {
    add_bridge(rings, hole, outer);
    return false;
  }
  const std::vector<Index> outer_nodes = nodes_of_ring(rings, outer);
  budget -= 4 * static_cast<std::int64_t>(outer_nodes.size());
  if (bridge_where_touching(rings, outer_nodes, hole)) return true;

  const GridPoint from = rings.at[hole];
  using Candidate = std::pair<double, Index>;
  std::vector<Candidate> candidates;  // a heap, the nearest on top
  candidates.reserve(outer_nodes.size());
  for (Index n : outer_nodes) {
    const double dx = double(rings.at[n].x - from.x), dy = double(rings.at[n].y - from.y);
    candidates.emplace_back(dx * dx + dy * dy, n);
  }
  std::ranges::make_heap(candidates, std::greater());
  const Index nearest = candidates.front().second;
  for (; !candidates.empty() && budget >= 0; candidates.pop_back()) {
    std::ranges::pop_heap(candidates, std::greater());
    const Index to = candidates.back().second;
    if (!goes_inside(rings, to, from)) continue;
    budget -= static_cast<std::int64_t>(rings.at.size());
    if (!sees(rings, from, rings.at[to])) continue;
    add_bridge(rings, hole, to);
    return true;
  }
  add_bridge(rings, hole, nearest);
  return false;
}

// The nodes that are not strictly convex, in square cells: only they can lie in an ear. A node that
// has become convex stays in its cell and is passed over.
class ReflexGrid {
 public:
  ReflexGrid(const Rings& rings, const std::vector<Index>& nodes) {
    std::vector<Index> reflex;
    for (Index n : nodes) {
      if (rings.turn(n) <= 0) reflex.push_back(n);
    }
    side_ = std::clamp(static_cast<std::int64_t>(std::sqrt(double(reflex.size()))), std::int64_t(1),
                       std::int64_t(1024));
    first_.assign(static_cast<std::size_t>(side_ * side_ + 1), 0);
    const auto cell_of = [&](Index n) {
      return static_cast<std::size_t>(cell(rings.at[n].y) * side_ + cell(rings.at[n].x));
    };
    for (Index n : reflex) ++first_[cell_of(n) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    nodes_.resize(reflex.size());
    std::vector<Index> fill(first_.begin(), first_.end() - 1);
    for (Index n : reflex) nodes_[fill[cell_of(n)]++] = n;
  }

  // Calls visit(node) for the nodes near the triangle until it returns true; the answer is whether
  // one did. `budget` pays for rows and nodes.
  template <typename Visit>
  bool any_near(const GridPoint& a, const GridPoint& b, const GridPoint& c, std::int64_t& budget,
                Visit visit) const {
    const std::int64_t x0 = cell(std::min({a.x, b.x, c.x})), x1 = cell(std::max({a.x, b.x, c.x}));
    const std::int64_t y0 = cell(std::min({a.y, b.y, c.y})), y1 = cell(std::max({a.y, b.y, c.y}));
    for (std::int64_t y = y0; y <= y1; ++y) {
      // The cells of a row are neighbours in memory.
      const Index begin = first_[static_cast<std::size_t>(y * side_ + x0)];
      const Index end = first_[static_cast<std::size_t>(y * side_ + x1 + 1)];
      budget -= 1 + std::int64_t(end - begin);
      for (Index i = begin; i < end; ++i) {
        if (visit(nodes_[i])) return true;
      }
    }
    return false;
  }

 private:
  std::int64_t cell(std::int64_t coordinate) const {
    return std::min((coordinate * side_) >> 29, side_ - 1);
  }
  std::int64_t side_ = 1;
  std::vector<Index> first_, nodes_;
};

// How much an ear may be doubted; a stage is entered when the one before finds nothing on a whole
// round, and left for the first one after a round that found something.
enum class Stage {
  Proper,      // strictly convex, no other node in the closed triangle
  Touching,    // strictly convex, no other node strictly inside
  Degenerate,  // no area: repeated points, spikes, points on a line
};

class EarClipper {
 public:
  EarClipper(Rings& rings, const std::vector<Index>& nodes, std::span<const Vec3d> points,
             std::int64_t budget, PolygonTriangles& out)
      : rings_(rings),
        grid_(rings, nodes),
        points_(points),
        budget_(budget),
        out_(out),
        remaining_(nodes.size()),
        removed_(rings.at.size(), false) {}

  void run(Index start) {
    Index n = start;
    Stage stage = Stage::Proper;
    while (remaining_ > 3) {
      bool clipped = false;
      for (std::size_t visits = remaining_; visits > 0 && remaining_ > 3; --visits) {
        if (--budget_ < 0) return fan(n);
        const Index next = rings_.next[n];
        if (!is_ear(n, stage)) {
          n = next;
          continue;
        }
        clip(n);
        clipped = true;
        // Going on with the neighbour's neighbour gives a strip rather than a fan of slivers.
        n = rings_.next[next];
      }
      if (clipped)
        stage = Stage::Proper;
      else if (stage == Stage::Degenerate)
        return fan(n);
      else
        stage = stage == Stage::Proper ? Stage::Touching : Stage::Degenerate;
    }
    out_.fanned |= rings_.turn(n) < 0;
    emit(rings_.previous[n], n, rings_.next[n]);
  }

 private:
  bool is_ear(Index n, Stage stage) {
    const Index before = rings_.previous[n], after = rings_.next[n];
    const GridPoint &a = rings_.at[before], &b = rings_.at[n], &c = rings_.at[after];
    // A repeated point is cut off at once: it hides nothing and would only confuse the tests.
    if (a == b || b == c) return true;
    const std::int64_t turn = orient(a, b, c);
    if (stage == Stage::Degenerate) return turn == 0;
    if (turn <= 0) return false;
    return !grid_.any_near(a, b, c, budget_, [&](Index other) {
      if (removed_[other] || other == before || other == n || other == after) return false;
      return blocks(a, b, c, other, stage);
    });
  }

  // True if node `other` forbids the ear abc.
  bool blocks(const GridPoint& a, const GridPoint& b, const GridPoint& c, Index other,
              Stage stage) const {
    const GridPoint& p = rings_.at[other];
    const std::int64_t ab = orient(a, b, p), bc = orient(b, c, p), ca = orient(c, a, p);
    if (ab < 0 || bc < 0 || ca < 0) return false;
    if (stage == Stage::Touching) return ab > 0 && bc > 0 && ca > 0;
    // A node in a corner of the ear (a bridge's other end, a ring that touches itself) does no harm
    // unless its edges go into the ear.
    if (p == a) return enters(a, b, c, other);
    if (p == b) return enters(b, c, a, other);
    if (p == c) return enters(c, a, b, other);
    return true;
  }

  // True if an edge of `other`, which lies at `tip`, runs between the directions to `right` and
  // `left`.
  bool enters(const GridPoint& tip, const GridPoint& right, const GridPoint& left,
              Index other) const {
    for (Index end : {rings_.previous[other], rings_.next[other]}) {
      const GridPoint& q = rings_.at[end];
      if (orient(tip, right, q) > 0 && orient(tip, q, left) > 0) return true;
    }
    return false;
  }

  void clip(Index n) {
    emit(rings_.previous[n], n, rings_.next[n]);
    rings_.remove(n);
    removed_[n] = true;
    --remaining_;
  }

  void fan(Index n) {
    out_.fanned = true;
    const Index tip = rings_.previous[n];
    for (; rings_.next[n] != tip; n = rings_.next[n]) emit(tip, n, rings_.next[n]);
  }

  void emit(Index a, Index b, Index c) {
    const Vec3d &pa = points_[rings_.point[a]], &pb = points_[rings_.point[b]];
    const Vec3d& pc = points_[rings_.point[c]];
    if (pa == pb || pb == pc || pc == pa) return;
    out_.triangles.push_back({rings_.point[a], rings_.point[b], rings_.point[c]});
  }

  Rings& rings_;
  ReflexGrid grid_;
  std::span<const Vec3d> points_;
  std::int64_t budget_;
  PolygonTriangles& out_;
  std::size_t remaining_;
  std::vector<bool> removed_;
};

void fan_all(std::size_t corner_count, std::span<const Vec3d> points, PolygonTriangles& out) {
  out.fanned = true;
  for (Index i = 1; i + 1 < corner_count; ++i) {
    if (points[0] == points[i] || points[i] == points[i + 1] || points[i + 1] == points[0])
      continue;
    out.triangles.push_back({0, i, i + 1});
  }
}

// The points on the grid, seen along the dominant axis of `normal` so that a ring with that normal
// runs counter-clockwise. Dropping an axis rounds nothing, so lines stay lines.
std::vector<GridPoint> project(std::span<const Vec3d> points, const Vec3d& normal) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  Vec3d low = points[0], high = points[0];
  for (const Vec3d& p : points) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const auto on_grid = [&](const Vec3d& p, int k) {
    const double extent = high[k] / 2 - low[k] / 2;  // halves: twice the range of a double is safe
    if (!(extent > 0)) return std::int64_t(0);
    return static_cast<std::int64_t>(std::llround((p[k] / 2 - low[k] / 2) / extent * kGridSteps));
  };
  std::vector<GridPoint> result;
  result.reserve(points.size());
  for (const Vec3d& p : points) result.push_back({on_grid(p, u), on_grid(p, v)});
  return result;
}

// A quadrilateral: the shorter of the diagonals that lie inside, else what the ears say.
bool cut_quad(std::span<const Vec3d> p, const Vec3d& normal, PolygonTriangles& out) {
  const auto turns_left = [&](Index a, Index b, Index c) {
    return dot(cross(p[b] - p[a], p[c] - p[a]), normal) > 0;
  };
  for (Index i = 0; i < 4; ++i) {
    if (!turns_left(i, (i + 1) % 4, (i + 2) % 4)) return false;
  }
  const Vec3d d02 = p[2] - p[0], d13 = p[3] - p[1];
  if (dot(d13, d13) < dot(d02, d02))
    out.triangles = {{0, 1, 3}, {1, 2, 3}};
  else
    out.triangles = {{0, 1, 2}, {0, 2, 3}};
  return true;
}

}  // namespace

Vec3d newell_normal(std::span<const Vec3d> ring) {
  Vec3d sum;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    sum += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  }
  return sum;
}

PolygonTriangles triangulate_polygon(std::span<const Vec3d> points,
                                     std::span<const std::uint32_t> hole_starts) {
  PolygonTriangles out;
  const std::size_t outer_count = hole_starts.empty() ? points.size() : hole_starts[0];
  if (outer_count < 3) return out;
  if (points.size() == 3) {
    if (points[0] != points[1] && points[1] != points[2] && points[2] != points[0]) {
      out.triangles = {{0, 1, 2}};
    }
    return out;
  }
  const Vec3d normal = newell_normal(points.first(outer_count));
  const double normal_length = length(normal);
  if (!(normal_length > 0) || !std::isfinite(normal_length)) {
    fan_all(outer_count, points, out);
    return out;
  }
  if (points.size() == 4 && outer_count == 4 && cut_quad(points, normal, out)) return out;

  Rings rings;
  rings.at = project(points, normal);
  rings.point.resize(points.size());
  std::iota(rings.point.begin(), rings.point.end(), Index(0));
  rings.next.resize(points.size());
  rings.previous.resize(points.size());

  // Link every ring; the outer one runs counter-clockwise already, the holes are made clockwise.
  std::int64_t budget = 500'000'000;
  std::vector<Index> leftmost;  // of each hole
  for (std::size_t h = 0; h <= hole_starts.size(); ++h) {
    const Index begin = h == 0 ? 0 : hole_starts[h - 1];
    const Index end = h == hole_starts.size() ? static_cast<Index>(points.size()) : hole_starts[h];
    if (end <= begin) continue;
    double area = 0;
    Index low = begin;
    for (Index i = begin; i < end; ++i) {
      const Index j = i + 1 == end ? begin : i + 1;
      rings.link(i, j);
      area += double(orient(rings.at[begin], rings.at[i], rings.at[j]));
      const GridPoint &a = rings.at[i], &b = rings.at[low];
      if (a.x < b.x || (a.x == b.x && a.y < b.y)) low = i;
    }
    if (h == 0) continue;
    if (area > 0) {
      for (Index i = begin; i < end; ++i) std::swap(rings.next[i], rings.previous[i]);
    }
    leftmost.push_back(low);
  }
  std::ranges::stable_sort(leftmost, {}, [&](Index n) { return rings.at[n].x; });
  for (Index hole : leftmost) out.fanned |= !bridge_hole(rings, 0, hole, budget);

  const std::vector<Index> nodes = nodes_of_ring(rings, 0);
  out.triangles.reserve(nodes.size() - 2);
  // Beginning with node 1 cuts a convex polygon's first corner off as (0, 1, 2), as readers expect.
  EarClipper(rings, nodes, points, budget, out).run(rings.next[0]);
  return out;
}

}  // namespace crease

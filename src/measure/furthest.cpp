#include "measure/furthest.h"

#include "measure/closest_point.h"
#include "measure/look_for_each.h"
#include "measure/same_triangles.h"
#include "parallel/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

namespace crease {

namespace {

// A piece goes on for so many queries before what is left of it is shared out anew, by what was
// found in between. Larger finds out later, smaller shares out more often.
constexpr std::size_t kQueriesATurn = 64;
constexpr std::size_t kPiecesARound = 512;
constexpr std::size_t kPiecesATask = 8;

// 88 MB. A thousand are left at once where a level is measured; this is for what nobody thought of.
constexpr std::size_t kMostLeft = 1'000'000;

using Corners = std::array<Vec3d, 3>;

struct Piece {
  Corners corner;
  double bound = 0;
  std::uint32_t near = kNone;  // a triangle to look at first

  // A heap has the piece on top that may be furthest.
  friend bool operator<(const Piece& a, const Piece& b) { return a.bound < b.bound; }
};

double longest_side(const Corners& corner) {
  return std::max({length(corner[1] - corner[0]), length(corner[2] - corner[1]),
                   length(corner[0] - corner[2])});
}

// One triangle of `to`, and the three planes that stand on its sides.
class Prism {
 public:
  Prism(const Surface& to, std::uint32_t triangle) {
    for (std::size_t c = 0; c < 3; ++c) corner_[c] = to.corner(triangle, c);
    up_ = normalized(cross(corner_[1] - corner_[0], corner_[2] - corner_[0]));
    for (std::size_t c = 0; c < 3; ++c) {
      out_[c] = normalized(cross(corner_[(c + 1) % 3] - corner_[c], up_));
    }
  }

  double squared_distance(const Vec3d& p) const {
    return closest_point(p, corner_[0], corner_[1], corner_[2]).squared_distance;
  }
  double height(const Vec3d& p) const { return std::abs(dot(p - corner_[0], up_)); }
  double outside(std::size_t side, const Vec3d& p) const {
    return dot(p - corner_[side], out_[side]);
  }
  double longest_side() const { return crease::longest_side(corner_); }

 private:
  Corners corner_;
  Vec3d up_;
  std::array<Vec3d, 3> out_;
};

// A part of a piece, or all of it, and the squared distances of its corners from the triangle that
// was found.
struct Part {
  Corners corner;
  std::array<double, 3> squared;

  // The distance from a triangle is convex.
  double bound() const { return std::sqrt(std::max({squared[0], squared[1], squared[2]})); }
};
using Parts = std::vector<Part>;

void halve(const Part& whole, const Prism& prism, Parts& parts) {
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3d side = whole.corner[(c + 1) % 3] - whole.corner[c];
    if (dot(side, side) <= most) continue;
    most = dot(side, side);
    longest = c;
  }
  const std::size_t a = longest, b = (longest + 1) % 3;
  const Vec3d middle = (whole.corner[a] + whole.corner[b]) * 0.5;
  const double squared = prism.squared_distance(middle);
  for (const std::size_t replaced : {a, b}) {
    parts.push_back(whole);
    parts.back().corner[replaced] = middle;
    parts.back().squared[replaced] = squared;
  }
}

// Cuts where `outside` changes its sign: the corner that is alone on its side, and the quad.
void cut(const Part& whole, const std::array<double, 3>& outside, const Prism& prism,
         Parts& parts) {
  std::size_t alone = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const bool is_out = outside[c] > 0;
    if (is_out != (outside[(c + 1) % 3] > 0) && is_out != (outside[(c + 2) % 3] > 0)) alone = c;
  }
  const std::size_t next = (alone + 1) % 3, last = (alone + 2) % 3;
  const Corners& p = whole.corner;
  const auto crossing = [&](std::size_t to) {
    return p[alone] + (p[to] - p[alone]) * (outside[alone] / (outside[alone] - outside[to]));
  };
  const Vec3d after = crossing(next), before = crossing(last);
  const double d_after = prism.squared_distance(after), d_before = prism.squared_distance(before);
  const std::array<double, 3>& d = whole.squared;
  parts.push_back({{p[alone], after, before}, {d[alone], d_after, d_before}});
  parts.push_back({{after, p[next], p[last]}, {d_after, d[next], d[last]}});
  parts.push_back({{after, p[last], before}, {d_after, d[last], d_before}});
}

// A piece much larger than the triangle is not cut: the cuts would go through all of it.
constexpr double kMuchLarger = 2;

// Cuts the piece where it leaves the prism furthest, if what is inside will then be settled.
bool cut_by(const Prism& prism, const Part& whole, double settled, Parts& parts) {
  for (const Vec3d& p : whole.corner) {
    if (prism.height(p) > settled) return false;
  }
  const double size = longest_side(whole.corner);
  if (size > kMuchLarger * prism.longest_side()) return false;
  // What is cut off must be more than rounding.
  const double least = 1e-7 * size;
  double most = least;
  std::array<double, 3> best{};
  for (std::size_t side = 0; side < 3; ++side) {
    std::array<double, 3> outside{};
    for (std::size_t c = 0; c < 3; ++c) outside[c] = prism.outside(side, whole.corner[c]);
    const auto [low, high] = std::minmax_element(outside.begin(), outside.end());
    if (*low > -least || *high <= most) continue;
    most = *high;
    best = outside;
  }
  if (most == least) return false;
  cut(whole, best, prism, parts);
  return true;
}

// Per triangle, whether it is any: one without area shows nothing, unless there is nothing else.
std::vector<char> surface_of(const Surface& from, double rounding) {
  std::vector<char> counts(from.triangle_count());
  bool any = false;
  for (std::size_t t = 0; t < counts.size(); ++t) {
    const Corners corner = {from.corner(t, 0), from.corner(t, 1), from.corner(t, 2)};
    const double twice_area = length(cross(corner[1] - corner[0], corner[2] - corner[0]));
    counts[t] = twice_area > rounding * longest_side(corner);
    any |= counts[t] != 0;
  }
  if (!any) counts.assign(counts.size(), 1);
  return counts;
}

class Search {
 public:
  Search(const Surface& from, const Surface& to, const FurthestOptions& options,
         SharedProgress& progress)
      : from_(from),
        to_(to),
        options_(options),
        progress_(progress),
        counts_(surface_of(from, options.absolute)),
        best_(options.at_least) {}

  Furthest run() {
    look_at_vertices();
    if (!is_over()) sort_triangles();
    while (!is_over() && !is_given_up() && take_pieces()) look_at_pieces();
    Furthest furthest{.distance = best_, .bound = settled(best_), .queries = queries_};
    if (next_ < waiting_.size()) {
      furthest.bound = std::max(furthest.bound, double(waiting_[next_].bound));
    }
    if (!left_.empty()) furthest.bound = std::max(furthest.bound, left_.front().bound);
    return furthest;
  }

 private:
  struct Waiting {
    float bound = 0;  // rounded up
    std::uint32_t triangle = 0;
  };
  // What a thread does with one piece.
  struct Turn {
    std::vector<Piece> heap;
    double best = 0;
    std::size_t queries = 0;
  };

  // What a piece's bound may be for it to be left alone.
  double settled(double best) const { return best * (1 + options_.relative) + options_.absolute; }
  bool is_over() const { return found_.load(std::memory_order_relaxed) || progress_.stopped(); }
  bool is_given_up() const { return queries_ >= options_.max_queries || left_.size() > kMostLeft; }
  bool is_found(double best) const {
    return options_.any_will_do && best > settled(options_.at_least);
  }

  template <typename Look>
  void for_each(std::size_t count, Look look) {
    look_for_each(
        count, progress_, [this] { return is_over(); }, look);
  }

  void look_at_vertices() {
    const Mesh& mesh = from_.mesh();
    std::vector<bool> used(mesh.vertex_count());
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (counts_[t] == 0) continue;
      for (VertexId v : mesh.triangles[t]) used[index_of(v)] = true;
    }
    distance_of_vertex_.assign(mesh.vertex_count(), 0);
    for_each(mesh.vertex_count(), [&](std::size_t v, Surface::Scratch& scratch) {
      if (!used[v]) return;
      const double distance = to_.nearest(from_.position(v), nullptr, 0, scratch).distance;
      distance_of_vertex_[v] = distance;
      if (is_found(distance)) found_ = true;
    });
    for (double d : distance_of_vertex_) best_ = std::max(best_, d);
  }

  // Of all triangles those that may be further, the worst first.
  void sort_triangles() {
    const Mesh& mesh = from_.mesh();
    const double enough = settled(best_);
    std::vector<Waiting> all(mesh.triangle_count());
    for_each(mesh.triangle_count(), [&](std::size_t t, Surface::Scratch&) {
      if (counts_[t] == 0) return;
      // A point of a triangle is at most 1 / sqrt(3) of the longest side from a corner.
      constexpr double kFromACorner = 0.57735027;
      double most = 0;
      Corners corner;
      for (std::size_t c = 0; c < 3; ++c) {
        corner[c] = from_.corner(t, c);
        most = std::max(most, distance_of_vertex_[index_of(mesh.triangles[t][c])]);
      }
      const double bound = most + kFromACorner * longest_side(corner);
      if (bound <= enough) return;
      all[t] = {std::nextafter(float(bound), HUGE_VALF), std::uint32_t(t)};
    });
    std::erase_if(all, [](const Waiting& w) { return w.bound == 0; });
    if (all.empty()) return;
    const SameTriangles same(to_.mesh());
    std::vector<char> is_same(all.size());
    parallel_ranges(all.size(), kLooksATask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) is_same[i] = same.has(mesh, all[i].triangle);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!is_same[i]) waiting_.push_back(all[i]);
    }
    parallel_sort(waiting_, [](const Waiting& a, const Waiting& b) {
      return a.bound != b.bound ? a.bound > b.bound : a.triangle < b.triangle;
    });
  }

  // The worst of what waits and of what is left, or nothing where all is settled.
  bool take_pieces() {
    turns_.clear();
    const double enough = settled(best_);
    while (turns_.size() < kPiecesARound) {
      const double of_waiting = next_ < waiting_.size() ? double(waiting_[next_].bound) : 0;
      const double of_left = left_.empty() ? 0 : left_.front().bound;
      if (std::max(of_waiting, of_left) <= enough) break;
      Piece piece;
      if (of_left >= of_waiting) {
        std::pop_heap(left_.begin(), left_.end());
        piece = left_.back();
        left_.pop_back();
      } else {
        const std::uint32_t t = waiting_[next_++].triangle;
        for (std::size_t c = 0; c < 3; ++c) piece.corner[c] = from_.corner(t, c);
        piece.bound = of_waiting;
      }
      turns_.push_back({.heap = {piece}});
    }
    return !turns_.empty();
  }

  // Each from what is known before the round, so that it does not matter who is first.
  void look_at_pieces() {
    parallel_ranges(turns_.size(), kPiecesATask, [&](std::size_t begin, std::size_t end) {
      Surface::Scratch scratch;
      Parts parts;
      for (std::size_t i = begin; i < end; ++i) {
        if (is_over()) return;
        look_at(turns_[i], scratch, parts);
      }
    });
    progress_.advance(0);
    for (const Turn& turn : turns_) {
      best_ = std::max(best_, turn.best);
      queries_ += turn.queries;
    }
    const double enough = settled(best_);
    for (const Turn& turn : turns_) {
      for (const Piece& piece : turn.heap) {
        if (piece.bound <= enough) continue;
        left_.push_back(piece);
        std::push_heap(left_.begin(), left_.end());
      }
    }
  }

  void look_at(Turn& turn, Surface::Scratch& scratch, Parts& parts) {
    std::vector<Piece>& heap = turn.heap;
    turn.best = best_;
    while (!heap.empty() && turn.queries < kQueriesATurn) {
      std::pop_heap(heap.begin(), heap.end());
      Piece piece = heap.back();
      heap.pop_back();
      if (piece.bound <= settled(turn.best)) continue;
      ++turn.queries;
      scratch.last_triangle = piece.near;
      const Vec3d middle = (piece.corner[0] + piece.corner[1] + piece.corner[2]) * (1.0 / 3);
      const Nearest nearest = to_.nearest(middle, nullptr, 0, scratch);
      turn.best = std::max(turn.best, nearest.distance);
      if (is_found(turn.best)) {
        found_ = true;
        return;
      }
      double reach = 0;
      for (const Vec3d& p : piece.corner) reach = std::max(reach, length(p - middle));
      const Prism prism(to_, nearest.triangle);
      Part whole{.corner = piece.corner, .squared = {}};
      for (std::size_t c = 0; c < 3; ++c) {
        whole.squared[c] = prism.squared_distance(piece.corner[c]);
      }
      piece.bound = std::min({piece.bound, nearest.distance + reach, whole.bound()});
      const double enough = settled(turn.best);
      if (piece.bound <= enough) continue;

      parts.clear();
      if (!cut_by(prism, whole, enough, parts)) halve(whole, prism, parts);
      for (const Part& part : parts) {
        const double bound = std::min(piece.bound, part.bound());
        if (bound <= enough) continue;
        heap.push_back({.corner = part.corner, .bound = bound, .near = nearest.triangle});
        std::push_heap(heap.begin(), heap.end());
      }
    }
  }

  const Surface& from_;
  const Surface& to_;
  const FurthestOptions& options_;
  SharedProgress& progress_;
  std::vector<char> counts_;  // per triangle
  std::vector<double> distance_of_vertex_;
  std::vector<Waiting> waiting_;  // triangles of which nothing has been looked at, from next_ on
  std::size_t next_ = 0;
  std::vector<Piece> left_;  // a heap
  std::vector<Turn> turns_;
  double best_;
  std::size_t queries_ = 0;
  std::atomic<bool> found_{false};  // with any_will_do: one that is further
};

}  // namespace

Furthest find_furthest(const Surface& from, const Surface& to, const FurthestOptions& options,
                       SharedProgress& progress) {
  return Search(from, to, options, progress).run();
}

}  // namespace crease

#include "render/crease_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace crease {

namespace {

const float kSameNormalCos = std::cos(kSameNormalDeg * 3.14159265f / 180);

bool is_same(const Vec3f& a, const Vec3f& b) {
  return dot(a, b) >= kSameNormalCos;
}

auto place_of(const Vec3f& p) {
  return std::tuple(p.x, p.y, p.z);
}

// A side of an edge, with the lower of its two positions as its key.
struct Side {
  std::uint32_t other = 0;  // position
  std::uint32_t low_corner = 0, high_corner = 0;
};

// Corners of the three parts in a row.
class Corners {
 public:
  Corners(const DrawList& list, const DrawRanges& ranges) : list_(list) {
    add(list.sn, ranges.sn, 0);
    add(list.fn, ranges.fn, 1);
    add(list.nsn, ranges.nsn, 3);
  }

  std::uint32_t count() const { return count_; }
  std::uint32_t position(std::uint32_t corner) const {
    const Stretch& s = stretch_of(corner);
    return s.part->indices[corner - s.first + s.skipped];
  }
  Vec3f normal(std::uint32_t corner) const {
    const Stretch& s = stretch_of(corner);
    const std::size_t in_part = corner - s.first + s.skipped;
    if (s.normals_each == 0) return list_.vertex_normals[s.part->indices[in_part]];
    return s.part->normals[s.normals_each == 1 ? in_part / 3 : in_part];
  }

 private:
  struct Stretch {
    const DrawPart* part = nullptr;
    std::uint32_t first = 0;  // its first corner here
    std::size_t skipped = 0;  // corners of the part before that
    int normals_each = 0;     // a triangle
  };

  void add(const DrawPart& part, const Range& range, int normals_each) {
    stretches_[stretch_count_++] = {&part, count_, 3 * std::size_t(range.first), normals_each};
    count_ += 3 * range.count;
  }
  const Stretch& stretch_of(std::uint32_t corner) const {
    return stretches_[corner >= stretches_[2].first ? 2 : corner >= stretches_[1].first ? 1 : 0];
  }

  const DrawList& list_;
  std::array<Stretch, 3> stretches_{};
  std::size_t stretch_count_ = 0;
  std::uint32_t count_ = 0;
};

// All sides of all edges, in a row for each lower position.
class Sides {
 public:
  Sides(const Corners& corners, std::size_t position_count) : first_(position_count + 1, 0) {
    each(corners, [&](std::uint32_t low, const Side&) { ++first_[low + 1]; });
    for (std::size_t p = 0; p < position_count; ++p) first_[p + 1] += first_[p];
    sides_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    each(corners, [&](std::uint32_t low, const Side& side) { sides_[next[low]++] = side; });
  }

  std::span<Side> of(std::uint32_t low) {
    return std::span(sides_).subspan(first_[low], first_[low + 1] - first_[low]);
  }

 private:
  template <typename Take>
  static void each(const Corners& corners, Take take) {
    for (std::uint32_t first = 0; first < corners.count(); first += 3) {
      std::uint32_t at[3];
      for (std::uint32_t c = 0; c < 3; ++c) at[c] = corners.position(first + c);
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t d = (c + 1) % 3;
        if (at[c] < at[d]) take(at[c], Side{at[d], first + c, first + d});
        if (at[c] > at[d]) take(at[d], Side{at[c], first + d, first + c});
      }
    }
  }

  std::vector<std::uint32_t> first_;
  std::vector<Side> sides_;
};

RimEdge rim_edge(const Vec3f& a, const Vec3f& b, const Vec3f& normal_a, const Vec3f& normal_b) {
  if (place_of(b) < place_of(a)) return {{b, a}, {normal_b, normal_a}};
  return {{a, b}, {normal_a, normal_b}};
}

}  // namespace

GroupLines lines_of(const DrawList& list, const DrawRanges& ranges) {
  const Corners corners(list, ranges);
  Sides sides(corners, list.positions.size());
  GroupLines lines;
  for (std::uint32_t low = 0; low < list.positions.size(); ++low) {
    const std::span<Side> around = sides.of(low);
    std::sort(around.begin(), around.end(), [](const Side& a, const Side& b) {
      return std::tie(a.other, a.low_corner) < std::tie(b.other, b.low_corner);
    });
    for (std::size_t begin = 0, end = 0; begin < around.size(); begin = end) {
      const Side& one = around[begin];
      const Vec3f low_normal = corners.normal(one.low_corner);
      const Vec3f high_normal = corners.normal(one.high_corner);
      bool is_hard = false;
      for (end = begin + 1; end < around.size() && around[end].other == one.other; ++end) {
        is_hard |= !is_same(low_normal, corners.normal(around[end].low_corner)) ||
                   !is_same(high_normal, corners.normal(around[end].high_corner));
      }
      const Vec3f &from = list.positions[low], &to = list.positions[one.other];
      if (is_hard) lines.hard.push_back({from, to});
      if (end == begin + 1) lines.rim.push_back(rim_edge(from, to, low_normal, high_normal));
    }
  }
  return lines;
}

CreaseLines join_rims(std::span<const std::span<const RimEdge>> rims) {
  std::vector<const RimEdge*> edges;
  for (const std::span<const RimEdge>& rim : rims) {
    for (const RimEdge& edge : rim) edges.push_back(&edge);
  }
  const auto ends = [](const RimEdge* e) {
    return std::tuple_cat(place_of(e->ends[0]), place_of(e->ends[1]));
  };
  std::sort(edges.begin(), edges.end(),
            [&](const RimEdge* a, const RimEdge* b) { return ends(a) < ends(b); });
  CreaseLines lines;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    const RimEdge& one = *edges[begin];
    bool is_hard = false;
    for (end = begin + 1; end < edges.size() && ends(edges[end]) == ends(&one); ++end) {
      for (std::size_t i = 0; i < 2; ++i) {
        is_hard |= !is_same(one.normals[i], edges[end]->normals[i]);
      }
    }
    const Line3f line{one.ends[0], one.ends[1]};
    if (end == begin + 1) lines.borders.push_back(line);
    if (is_hard) lines.hard.push_back(line);
  }
  return lines;
}

CreaseLines crease_lines(const DrawList& list) {
  GroupLines found = lines_of(list, all_of(list));
  CreaseLines lines;
  lines.hard = std::move(found.hard);
  for (const RimEdge& edge : found.rim) lines.borders.push_back({edge.ends[0], edge.ends[1]});
  return lines;
}

}  // namespace crease

#include "codec/order_contractions.h"

#include "codec/contracting_patch.h"
#include "codec/face_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace crease::codec {

namespace {

// What a face that turns by one radian costs beside one that moves by a mean edge length.
constexpr double kTurnWeight = 0.9;
// The turn counts in proportion to its chord up to this one, and to the chord's square beyond, as
// in the simplifier: squares alone make small errors all but free.
constexpr double kLinearChord = 0.8;
constexpr double kRoundingChord = 0.01;  // turns below this count less: grids round
// What the area of a part that disappears counts: quadrics count it at each of its three corners.
constexpr double kPartWeight = 3;
// Between two faces an edge is a line only where the surface really bends (30 degrees): where all
// is flat, every edge is hard, and few are features.
constexpr double kFlatLineCosine = 0.866;
constexpr double kMostCost = 1e300;  // of nonsense, that a hostile block may have

Vec3d real(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

// The sum of weighted squared distances from planes (Garland and Heckbert 1997).
struct PlaneQuadric {
  std::array<double, 10> a{};  // xx xy xz xw yy yz yw zz zw ww
  double weight_sum = 0;

  void add(const Vec3d& normal, double offset, double weight) {
    weight_sum += weight;
    const std::array<double, 4> p{normal.x, normal.y, normal.z, offset};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i; j < 4; ++j) a[k++] += weight * p[i] * p[j];
    }
  }
  void add(const PlaneQuadric& other) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] += other.a[k];
    weight_sum += other.weight_sum;
  }
  // The root of the mean.
  double distance(const Vec3d& p) const {
    return weight_sum > 0 ? std::sqrt(std::max(0.0, at(p)) / weight_sum) : 0;
  }
  double at(const Vec3d& p) const {
    return a[0] * p.x * p.x + a[4] * p.y * p.y + a[7] * p.z * p.z + a[9] +
           2 * (a[1] * p.x * p.y + a[2] * p.x * p.z + a[5] * p.y * p.z + a[3] * p.x + a[6] * p.y +
                a[8] * p.z);
  }
};

class CostEstimator {
 public:
  CostEstimator(const UnfoldedBlock& block, const BlockCoding& coding,
                std::span<const LayerSchema> layers, std::span<const LayerValues> values)
      : mesh_(block.end),
        coding_(coding),
        positions_(block.end.positions),
        surface_(block.end.positions.size()),
        lines_(block.end.positions.size()),
        // Near, so that little is lost in differences.
        origin_(positions_.empty() ? Vec3d{} : real(positions_[0])),
        wedges_(block, layers, values, origin_) {
    double edges = 0;
    for (const Corners& t : mesh_.triangles) {
      const std::array<Vec3d, 3> p{place(t[0]), place(t[1]), place(t[2])};
      for (std::size_t c = 0; c < 3; ++c) edges += length(p[(c + 1) % 3] - p[c]);
      const Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
      const double twice_area = length(n);
      if (twice_area == 0) continue;
      const Vec3d unit = n * (1 / twice_area);
      for (const std::uint32_t v : t) surface_[v].add(unit, -dot(unit, p[0]), 0.5 * twice_area);
    }
    find_faces();
    faces_.emplace(block, coding, values, is_face_);
    add_lines();
    const double count = 3 * double(std::max<std::size_t>(1, mesh_.triangles.size()));
    turn_weight_ = kTurnWeight * edges / count;
    turn_weight_ *= turn_weight_;
  }

  // Of contracting `second` into `first`, which then stands at `parent`. See own() as well.
  double contract(ContractingPatch& patch, std::uint32_t first, std::uint32_t second,
                  const Vec3i& parent) {
    surface_[first].add(surface_[second]);
    lines_[first].add(lines_[second]);
    const Vec3d s = real(parent) - origin_, t = place(first), u = place(second);
    double cost = std::max(0.0, surface_[first].at(s) + lines_[first].at(s));
    double surface = surface_[first].distance(s);
    const std::array<Vec3d, 2> before{t, u};
    const auto vanished = patch.contract(first, second);
    const std::span<const std::uint32_t> around = patch.around(first);
    const std::size_t from_first = around.size() - patch.moved_count();
    for (std::size_t i = 0; i < around.size(); ++i) {
      if (!is_face_[around[i]]) continue;
      cost += turning_cost(patch.corners(around[i]), first, before[i >= from_first], s);
    }
    for (const std::uint32_t v : vanished) {
      if (!is_face_[v]) continue;
      cost += vanishing_cost(patch, patch.corners(v), around, first, s);
    }
    if (around.empty()) {
      double longest = 0;
      for (const std::uint32_t v : vanished) {
        cost += kPartWeight * part_cost(patch.corners(v));
        longest = std::max(longest, longest_side2(patch.corners(v)));
      }
      surface += std::sqrt(longest);  // what it stood for is gone
    }
    cost += wedges_.contract(patch, vanished, first, second, s);
    positions_[first] = parent;
    const float turned = faces_->contract(patch, vanished, first, positions_);
    own_ = {static_cast<float>(surface), static_cast<float>(lines_[first].distance(s)),
            std::max(wedges_.degrees(), turned), wedges_.texture()};
    return cost <= kMostCost ? cost : kMostCost;  // also if it is no number
  }

  // Of the last contraction: see OrderedContraction.
  const LevelError& own() const { return own_; }

  std::vector<WedgeValues> take_wedges() { return std::move(wedges_).take(); }

 private:
  Vec3d place(std::uint32_t v) const { return real(positions_[v]) - origin_; }

  double longest_side2(const Corners& t) const {
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d edge = place(t[(c + 1) % 3]) - place(t[c]);
      longest = std::max(longest, dot(edge, edge));
    }
    return longest;
  }
  // Its area at its own length's distance.
  double part_cost(const Corners& t) const {
    const Vec3d twice = cross(place(t[1]) - place(t[0]), place(t[2]) - place(t[0]));
    return 0.5 * length(twice) * longest_side2(t);
  }

  double turning_cost(const Corners& corners, std::uint32_t moved, const Vec3d& from,
                      const Vec3d& to) const {
    std::array<Vec3d, 3> p;
    std::size_t at = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (corners[c] == moved) at = c;
      p[c] = place(corners[c]);
    }
    const Vec3d &next = p[(at + 1) % 3], &last = p[(at + 2) % 3];
    const Vec3d before = cross(next - from, last - from), after = cross(next - to, last - to);
    const double size = length(before), size_after = length(after);
    if (size == 0 || size_after == 0) return 0;
    const double cosine = std::clamp(dot(before, after) / (size * size_after), -1.0, 1.0);
    const double chord2 = 2 * (1 - cosine);
    const double weighed =
        chord2 * std::max(1.0, kLinearChord / (std::sqrt(chord2) + kRoundingChord));
    return 0.5 * turn_weight_ * size_after * weighed;
  }

  // The direction of what vanishes, unless something around it has the same.
  double vanishing_cost(const ContractingPatch& patch, const Corners& corners,
                        std::span<const std::uint32_t> around, std::uint32_t moved,
                        const Vec3d& to) const {
    const Vec3d n =
        cross(place(corners[1]) - place(corners[0]), place(corners[2]) - place(corners[0]));
    const double size = length(n);
    if (size == 0) return 0;
    double best = -1;
    for (const std::uint32_t t : around) {
      std::array<Vec3d, 3> p;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = patch.corners(t)[c];
        p[c] = v == moved ? to : place(v);
      }
      const Vec3d other = cross(p[1] - p[0], p[2] - p[0]);
      const double other_size = length(other);
      if (other_size > 0) best = std::max(best, dot(n, other) / (size * other_size));
    }
    return turn_weight_ * size * std::max(0.0, 1 - best);
  }

  // Triangles that show one normal, or have none of their own. Where a triangle's normal varies,
  // its wedges say what turning costs.
  void find_faces() {
    is_face_.assign(mesh_.triangles.size(), 1);
    for (std::size_t l = 0; l < coding_.layers.size(); ++l) {
      if (!coding_.layers[l].is_normal) continue;
      for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        const CodedValue* values = &mesh_.values[l][3 * t];
        if (mesh_.derived[t] || (values[0] == values[1] && values[1] == values[2])) continue;
        is_face_[t] = 0;
      }
    }
  }

  struct Edge {
    std::uint32_t a = 0, b = 0, triangle = 0;
  };

  // Borders, and edges with other values on the other side, hold their vertices by planes that
  // stand upright on the triangles.
  void add_lines() {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [a, b] = std::minmax(mesh_.triangles[t][c], mesh_.triangles[t][(c + 1) % 3]);
        edges.push_back({a, b, t});
      }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
      return x.a != y.a ? x.a < y.a : x.b != y.b ? x.b < y.b : x.triangle < y.triangle;
    });
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end].a == edges[begin].a &&
             edges[end].b == edges[begin].b) {
        ++end;
      }
      if (end == begin + 2 && is_smooth(edges[begin], edges[begin + 1])) continue;
      for (std::size_t i = begin; i < end; ++i) add_line(edges[i]);
    }
  }

  void add_line(const Edge& edge) {
    const Corners& t = mesh_.triangles[edge.triangle];
    const Vec3d a = place(edge.a), along = place(edge.b) - a;
    const Vec3d across = cross(along, cross(place(t[1]) - place(t[0]), place(t[2]) - place(t[0])));
    const double size = length(across);
    if (size == 0) return;
    const Vec3d unit = across * (1 / size);
    for (const std::uint32_t v : {edge.a, edge.b}) {
      lines_[v].add(unit, -dot(unit, a), dot(along, along));
    }
  }

  bool bends(std::uint32_t t, std::uint32_t u) const {
    const Vec3d a = scaled_normal(t), b = scaled_normal(u);
    return dot(a, b) < kFlatLineCosine * length(a) * length(b);
  }

  Vec3d scaled_normal(std::uint32_t t) const {
    const Corners& c = mesh_.triangles[t];
    return cross(place(c[1]) - place(c[0]), place(c[2]) - place(c[0]));
  }

  bool is_smooth(const Edge& x, const Edge& y) const {
    if (mesh_.category[x.triangle] != mesh_.category[y.triangle]) return false;
    for (std::size_t l = 0; l < coding_.layers.size(); ++l) {
      if (coding_.layers[l].is_normal && is_face_[x.triangle] && is_face_[y.triangle]) {
        if (bends(x.triangle, y.triangle)) return false;
        continue;
      }
      if (coding_.layers[l].is_normal && (mesh_.derived[x.triangle] || mesh_.derived[y.triangle])) {
        continue;
      }
      for (const std::uint32_t v : {x.a, x.b}) {
        if (value(l, x.triangle, v) != value(l, y.triangle, v)) return false;
      }
    }
    return true;
  }

  const CodedValue& value(std::size_t layer, std::uint32_t t, std::uint32_t v) const {
    const Corners& corners = mesh_.triangles[t];
    const std::size_t c = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
    return mesh_.values[layer][3 * std::size_t(t) + c];
  }

  const PatchMesh& mesh_;
  const BlockCoding& coding_;
  std::vector<Vec3i> positions_;
  std::vector<PlaneQuadric> surface_, lines_;  // per vertex, about origin_
  LevelError own_;
  std::optional<FaceNormals> faces_;
  Vec3d origin_;
  WedgeQuadrics wedges_;
  std::vector<char> is_face_;  // per triangle; see find_faces()
  double turn_weight_ = 0;
};

}  // namespace

ContractionOrder order_contractions(const UnfoldedBlock& block, const BlockCoding& coding,
                                    std::span<const LayerSchema> layers,
                                    std::span<const LayerValues> values) {
  ContractingPatch patch(block.end);
  CostEstimator estimator(block, coding, layers, values);
  std::vector<double> cost_of_vertex(block.vertices.size(), 0);
  std::vector<OrderedContraction> order;
  order.reserve(block.splits.size());
  for (std::size_t i = block.splits.size(); i-- > 0;) {
    const Split& split = block.splits[i];
    const std::uint32_t first = split.vertex, second = block.second_child(i);
    const double cost = std::max({estimator.contract(patch, first, second, split.parent_position),
                                  cost_of_vertex[first], cost_of_vertex[second]});
    cost_of_vertex[first] = cost;
    order.push_back({static_cast<std::uint32_t>(i), cost, estimator.own()});
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const OrderedContraction& a, const OrderedContraction& b) { return a.cost < b.cost; });
  return {std::move(order), estimator.take_wedges()};
}

}  // namespace crease::codec

#include "codec/defer_folds.h"

#include "base/wide.h"
#include "codec/contracting_patch.h"
#include "codec/patch_geometry.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace crease::codec {

namespace {

constexpr int kMostTries = 2;
constexpr double kLonger = 2;  // then it waits until others cost so much more

class Deferral {
 public:
  Deferral(const UnfoldedBlock& block, std::vector<OrderedContraction> order)
      : block_(block),
        order_(std::move(order)),
        patch_(block.end),
        places_(block.end),
        waits_for_(block.end.positions.size(), 0) {
    twice_areas_.reserve(block.end.triangles.size());
    for (const Corners& t : block.end.triangles) twice_areas_.push_back(places_.twice_area(t));
  }

  CREASE_WIDE std::vector<OrderedContraction> run() {
    std::vector<OrderedContraction> done;
    done.reserve(order_.size());
    for (std::size_t next = 0; next < order_.size() || !waiting_.empty();) {
      if (!waiting_.empty() &&
          (next == order_.size() || waiting_.front().cost <= order_[next].cost)) {
        std::pop_heap(waiting_.begin(), waiting_.end(), Later{});
        Waiting waiting = waiting_.back();
        waiting_.pop_back();
        OrderedContraction& c = order_[waiting.place];
        const double with_children = waits_until(c);
        if (with_children > waiting.cost) {
          wait(with_children, waiting);
          continue;
        }
        const double fold = look_at(c);
        if (fold > 0 && waiting.tries < kMostTries && (next < order_.size() || !waiting_.empty())) {
          ++waiting.tries;
          wait(std::max(kLonger * waiting.cost, fold), waiting);
          continue;
        }
        contract(c);
        done.push_back(c);
        continue;
      }
      OrderedContraction& c = order_[next];
      const double cost = std::max(waits_until(c), c.cost + look_at(c));
      if (cost > c.cost) {
        wait(cost, {cost, static_cast<std::uint32_t>(next), 0});
      } else {
        contract(c);
        done.push_back(c);
      }
      ++next;
    }
    return done;
  }

 private:
  struct Waiting {
    double cost;
    std::uint32_t place;  // in order_: children come before their parents
    int tries;            // so often it still folded when it had waited
  };
  struct Later {
    bool operator()(const Waiting& a, const Waiting& b) const {
      return a.cost > b.cost || (a.cost == b.cost && a.place > b.place);
    }
  };

  void wait(double cost, Waiting waiting) {
    OrderedContraction& c = order_[waiting.place];
    double& until = waits_for_[first_of(c)];
    until = std::max(until, cost);
    waiting.cost = c.cost = cost;
    waiting_.push_back(waiting);
    std::push_heap(waiting_.begin(), waiting_.end(), Later{});
  }

  std::uint32_t first_of(const OrderedContraction& c) const {
    return block_.splits[c.split].vertex;
  }
  std::uint32_t second_of(const OrderedContraction& c) const {
    return block_.second_child(c.split);
  }

  // What the children cost at last, that wait or have waited.
  double waits_until(const OrderedContraction& c) const {
    return std::max(waits_for_[first_of(c)], waits_for_[second_of(c)]);
  }

  // How its triangles would turn; returns what folding costs.
  double look_at(const OrderedContraction& c) {
    const std::uint32_t first = first_of(c), second = second_of(c);
    const Vec3d to = places_.from_origin(block_.splits[c.split].parent_position);
    double area = 0;
    turned_.clear();
    for (const auto& [moved, other] : {std::pair{first, second}, std::pair{second, first}}) {
      for (const std::uint32_t t : patch_.around(moved)) {
        const Corners& corners = patch_.corners(t);
        const std::size_t at = corner_of(corners, moved);
        const std::uint32_t next = corners[kCornerAfter[at]], previous = corners[kCornerBefore[at]];
        if (next == other || previous == other) continue;
        const Vec3d after = cross(places_.place(next) - to, places_.place(previous) - to);
        const Vec3d& before = twice_areas_[t];
        if (dot(before, after) <= 0 && dot(before, before) > 0) {
          area += 0.5 * (length(before) + length(after));
        }
        turned_.emplace_back(t, after);
      }
    }
    const Vec3d step = places_.place(second) - places_.place(first);
    return area * dot(step, step);
  }

  // The one that was looked at last.
  void contract(const OrderedContraction& c) {
    const std::uint32_t first = first_of(c);
    patch_.contract(first, second_of(c));
    places_.move(first, places_.from_origin(block_.splits[c.split].parent_position));
    for (const auto& [t, after] : turned_) twice_areas_[t] = after;
  }

  const UnfoldedBlock& block_;
  std::vector<OrderedContraction> order_;
  ContractingPatch patch_;
  PatchPlaces places_;
  std::vector<Vec3d> twice_areas_;  // per triangle, along its normal
  std::vector<double>
      waits_for_;                 // per vertex: the cost of the contraction that last waited for it
  std::vector<Waiting> waiting_;  // a heap, the cheapest on top
  std::vector<std::pair<std::uint32_t, Vec3d>> turned_;  // scratch of look_at()
};

}  // namespace

std::vector<OrderedContraction> defer_folds(const UnfoldedBlock& block,
                                            std::vector<OrderedContraction> order) {
  return Deferral(block, std::move(order)).run();
}

}  // namespace crease::codec

#include "runtime/block_cut.h"

#include "base/assert.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

namespace crease {

namespace {

constexpr int kLooksOnOdometer = 4096;  // as in the refiner
constexpr double kNow = -std::numeric_limits<double>::infinity();

// Of all cuts of the program, so that a block that comes again has others than before.
std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

BlockCut::BlockCut(ResidentBlockPtr block, BlockHierarchyPtr hierarchy,
                   std::span<const SplitBounds> bounds)
    : block_(std::move(block)), hierarchy_(std::move(hierarchy)), bounds_(bounds) {}

void BlockCut::look_anew() {
  seen_ = kind_ = 0;
  if (live_) live_->refiner.look_anew();
}

BlockLinks& BlockCut::links() {
  if (!links_) links_ = std::make_unique<BlockLinks>(data());
  is_dirty_ = true;
  return *links_;
}

UpdateReport BlockCut::update(const ViewNow& now, bool may_look) {
  UpdateReport report;
  const bool looks = may_look || !has_view_;
  is_dirty_ = false;
  if (looks) {
    const bool is_other = std::exchange(kind_, now.kind) != now.kind;
    seen_ = now.number;
    view_ = now.view;
    has_view_ = true;
    if (is_other && !live_ && !is_whole_) watch_roots(now);
  }
  if (!live_) {
    if (!must_wake(now, looks, report)) return report;
    wake();
  }
  const UpdateReport moved = move();
  report.splits = moved.splits;
  report.merges = moved.merges;
  report.evaluated += moved.evaluated;
  if (looks) set_due(now, live_->refiner.slack());
  return report;
}

// All leaves are held, and all triangles are shown by others.
bool BlockCut::is_covered() const {
  return links_ && links_->required_count() == data().requirable_splits &&
         links_->hidden_count() == data().roots_of_triangle.size();
}

bool BlockCut::must_wake(const ViewNow& now, bool looks, UpdateReport& report) {
  if (is_whole_) return !is_covered();
  if (data().shows_roots || (links_ && links_->required_count() > 0)) return true;
  return looks && finds_wrong_root(now, report);
}

void BlockCut::watch_roots(const ViewNow& now) {
  const VertexHierarchy& h = data().hierarchy.vertices;
  const auto count = static_cast<std::uint32_t>(data().root_of_split.size());
  watched_roots_.resize(count, now.error.uses_cones());
  for (std::uint32_t s = 0; s < count; ++s) {
    const NodeId root = h.node_of_split[s];
    const bool is_used = h.root_wedges[index_of(root)] < h.root_wedges[index_of(root) + 1];
    const Vec3f position = now.error.position(h.root_positions[index_of(root)]);
    watched_roots_.set(s, is_used ? now.error.watch(bounds_[s], position, 1) : Watch{});
  }
  looks_ = kLooksOnOdometer;
}

bool BlockCut::finds_wrong_root(const ViewNow& now, UpdateReport& report) {
  if (++looks_ > kLooksOnOdometer) {
    watched_roots_.look_at_all();
    watched_from_travel_ = now.travel;
    watched_from_turn_ = now.turn;
    looks_ = 0;
  }
  const Odometer odometer{now.travel - watched_from_travel_, now.turn - watched_from_turn_,
                          1e-6f * now.error.eye_length(), Odometer::ratio(now.turn, now.travel)};
  bool any = false;
  report.evaluated +=
      watched_roots_.find<true>(now.error, odometer, [&any](std::uint32_t) { any = true; });
  set_due(now, watched_roots_.slack(odometer));
  return any;
}

void BlockCut::wake() {
  if (!links_) links_ = std::make_unique<BlockLinks>(data());
  live_ = std::make_unique<Live>(data().hierarchy, links_->hidden().data());
  is_whole_ = false;
  watched_roots_ = {};
  live_->refiner.use_bounds(bounds_);
  live_->refiner.use_required(links_->required());
  for (std::uint32_t v = 0; v < data().leaf_of_vertex.size(); ++v) {
    if (!links_->is_held(v) || data().wedge_of_vertex[v] == kNone) continue;
    live_->refiner.require(WedgeId{data().wedge_of_vertex[v]}, data().leaf_of_vertex[v]);
  }
}

// The cut, then what that shows.
UpdateReport BlockCut::move() {
  ActiveCut& cut = live_->cut;
  Refiner& refiner = live_->refiner;
  for (const SplitId s : links_->required_changes()) {
    links_->required()[index_of(s)] != 0 ? refiner.hold(cut, s) : refiner.release(cut, s);
  }
  for (const std::uint32_t v : links_->newly_held()) {
    if (!links_->is_held(v)) continue;
    refiner.require(WedgeId{data().wedge_of_vertex[v]}, data().leaf_of_vertex[v]);
  }
  const UpdateReport report = refiner.update(cut, view_);
  links_->set_root_splits(cut.done_words());
  for (const TriangleId t : links_->hidden_changes()) cut.hide_or_show(t);
  const bool has_changed = report.splits + report.merges > 0 || !links_->hidden_changes().empty();
  if (!has_changed && live_->is_drawn) return report;
  live_->is_drawn = true;
  live_->drawing.arrive(cut, live_->at_rest);
  revision_ = next_revision();
  return report;
}

void BlockCut::set_due(const ViewNow& now, const WatchList::Slack& slack) {
  due_travel_ = slack.travel > 0 ? now.travel + slack.travel : kNow;
  due_turn_ = slack.turn > 0 ? now.turn + slack.turn : kNow;
}

bool BlockCut::could_rest() const {
  if (!live_) return false;
  const bool has_nothing = links_->split_root_count() == 0 && links_->required_count() == 0;
  return is_covered() || (has_nothing && !data().shows_roots);
}

void BlockCut::rest() {
  CREASE_ASSERT(could_rest());
  is_whole_ = is_covered();
  live_.reset();
  if (!is_whole_) seen_ = kind_ = 0;
  if (links_->is_unused()) links_.reset();
}

DrawList BlockCut::draw_list() const {
  DrawList list = live_->drawing.draw_list(live_->cut);
  list.materials = block_->data().schema->materials;
  return list;
}

LevelError BlockCut::error() const {
  LevelError worst;
  if (live_) {
    for (const ActiveVertex& v : live_->cut.vertices()) {
      if (v.node == kNoNode || v.split == kNoSplit) continue;
      worst = larger(worst, bounds_[index_of(v.split)].error());
    }
  } else if (!is_whole_) {
    for (std::size_t s = 0; s < data().root_of_split.size(); ++s) {
      worst = larger(worst, bounds_[s].error());
    }
  }
  return worst;
}

std::size_t BlockCut::bytes() const {
  std::size_t sum = sizeof(*this) + watched_roots_.bytes() + (links_ ? links_->bytes() : 0);
  if (!live_) return sum;
  return sum + sizeof(Live) + live_->cut.bytes() + live_->refiner.bytes() + live_->drawing.bytes() +
         live_->at_rest.bytes();
}

}  // namespace crease

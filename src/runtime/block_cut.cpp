#include "runtime/block_cut.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

namespace crease {

namespace {

// Of all cuts of the program, so that a block that comes again has others than before.
std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

template <typename T>
std::size_t bytes_of_room(const std::vector<T>& all) {
  return all.capacity() * sizeof(T);
}

// The view of one block among many: budgets are the mesh's.
ViewParameters without_budgets(ViewParameters view) {
  view.max_triangles = std::numeric_limits<std::size_t>::max();
  view.max_seconds = std::numeric_limits<double>::infinity();
  view.clock = nullptr;
  view.clock_context = nullptr;
  return view;
}

}  // namespace

std::size_t BlockCut::ShownPart::bytes() const {
  return bytes_of_room(indices) + bytes_of_room(triangles) + bytes_of_room(materials) +
         bytes_of_room(normals) + bytes_of_room(colors) + bytes_of_room(texcoords);
}

BlockCut::BlockCut(ResidentBlockPtr block, BlockHierarchyPtr hierarchy,
                   std::span<const SplitBounds> bounds)
    : block_(std::move(block)),
      hierarchy_(std::move(hierarchy)),
      bounds_(bounds),
      cut_(data().hierarchy),
      at_rest_(data().hierarchy) {
  refiner_.use_bounds(bounds_);
  held_.assign(data().leaf_of_vertex.size(), 0);
  taken_.assign(data().roots_of_triangle.size(), 0);
  is_root_split_.assign(data().node_of_root.size(), 0);
  needed_roots_.assign(data().node_of_root.size(), 0);
  takes_.assign(block_->data().coarse_triangles, 0);
}

void BlockCut::set_wants(std::vector<char> held, std::vector<char> taken) {
  if (taken != taken_) {
    taken_ = std::move(taken);
    has_moved_ = has_new_taken_ = true;
  }
  if (held == held_) return;
  held_ = std::move(held);
  is_stale_ = true;
  std::vector<Refiner::Required> required;
  for (std::uint32_t v = 0; v < held_.size(); ++v) {
    if (!held_[v] || data().wedge_of_vertex[v] == kNone) continue;
    required.push_back({WedgeId{data().wedge_of_vertex[v]}, data().leaf_of_vertex[v]});
  }
  refiner_.require(cut_, std::move(required));
}

UpdateReport BlockCut::update(const ViewParameters& view) {
  view_ = view;
  has_view_ = true;
  is_stale_ = false;
  const UpdateReport report = refiner_.update(cut_, without_budgets(view));
  has_moved_ |= report.splits + report.merges > 0;
  return report;
}

bool BlockCut::finish() {
  if (!has_moved_) return false;
  has_moved_ = false;
  drawing_.arrive(cut_, at_rest_);
  const bool has_changed = find_split_roots() || has_new_taken_;
  const std::vector<char> needed = needed_roots_, takes = takes_;
  if (has_changed) find_shown();
  has_new_taken_ = false;
  const DrawList all = drawing_.draw_list(cut_);
  copy_shown(all.sn, cut_.parts()[kSnPart], sn_);
  copy_shown(all.fn, cut_.parts()[kFnPart], fn_);
  copy_shown(all.nsn, cut_.parts()[kNsnPart], nsn_);
  revision_ = next_revision();
  return needed != needed_roots_ || takes != takes_;
}

// True if they are others than before.
bool BlockCut::find_split_roots() {
  bool has_changed = shows_.empty();
  for (std::size_t r = 0; r < is_root_split_.size(); ++r) {
    const char is_split = !cut_.is_cut_leaf(data().node_of_root[r]);
    has_changed |= is_split != is_root_split_[r];
    is_root_split_[r] = is_split;
  }
  return has_changed;
}

// One pass over the triangles of the fine end, active or not.
void BlockCut::find_shown() {
  std::fill(needed_roots_.begin(), needed_roots_.end(), 0);
  shows_.resize(data().roots_of_triangle.size());
  for (std::size_t t = 0; t < shows_.size(); ++t) {
    const auto& [a, b, c] = data().roots_of_triangle[t];
    const bool is_split = is_root_split_[a] || is_root_split_[b] || is_root_split_[c];
    if (is_split) needed_roots_[a] = needed_roots_[b] = needed_roots_[c] = 1;
    const bool is_coarse = t < takes_.size();
    if (is_coarse) takes_[t] = is_split || taken_[t];
    shows_[t] = !taken_[t] && (is_split || !is_coarse);
  }
}

void BlockCut::copy_shown(const DrawPart& all, const ActiveTriangles& triangles,
                          ShownPart& shown) const {
  shown.indices.clear();
  shown.triangles.clear();
  shown.materials.clear();
  shown.normals.clear();
  shown.colors.clear();
  shown.texcoords.clear();
  const std::size_t count = triangles.size();
  const std::size_t normals = count > 0 ? all.normals.size() / count : 0;
  const auto append = [](auto& to, const auto& from, std::size_t first, std::size_t size) {
    to.insert(to.end(), from.begin() + std::ptrdiff_t(first),
              from.begin() + std::ptrdiff_t(first + size));
  };
  for (std::size_t t = 0; t < count; ++t) {
    if (!is_shown(triangles.ids[t])) continue;
    append(shown.indices, all.indices, 3 * t, 3);
    shown.triangles.push_back(data().triangle_of[index_of(triangles.ids[t])]);
    append(shown.normals, all.normals, normals * t, normals);
    if (!all.materials.empty()) shown.materials.push_back(all.materials[t]);
    if (!all.colors.empty()) append(shown.colors, all.colors, 3 * t, 3);
    if (!all.texcoords.empty()) append(shown.texcoords, all.texcoords, 3 * t, 3);
  }
}

DrawList BlockCut::draw_list() const {
  DrawList list = drawing_.draw_list(cut_);
  list.sn = sn_.draw();
  list.fn = fn_.draw();
  list.nsn = nsn_.draw();
  list.materials = block_->data().schema->materials;
  return list;
}

LevelError BlockCut::error() const {
  LevelError worst;
  for (const ActiveVertex& v : cut_.vertices()) {
    if (v.node == kNoNode || v.split == kNoSplit) continue;
    worst = larger(worst, bounds_[index_of(v.split)].error());
  }
  return worst;
}

std::size_t BlockCut::bytes() const {
  return sizeof(*this) + cut_.bytes() + refiner_.bytes() + drawing_.bytes() + at_rest_.bytes() +
         held_.size() + taken_.size() + needed_roots_.size() + takes_.size() + shows_.size() +
         is_root_split_.size() + sn_.bytes() + fn_.bytes() + nsn_.bytes();
}

}  // namespace crease

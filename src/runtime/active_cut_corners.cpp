// Corners, which follow vertices that have moved.
#include "runtime/active_cut.h"

#include <algorithm>
#include <array>
#include <bit>

namespace crease {

// With the memory of the next ones on its way.
template <typename Visit>
void ActiveCut::visit_all(const std::vector<Following>& all, Visit visit) {
  const std::size_t count = all.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 8 < count) prefetch_vertex(all[i + 8].slot);
    visit(all[i]);
  }
}

// The same for those of which moves(f) holds, with that of the triangles of their corners.
template <typename Moves, typename Visit>
void ActiveCut::visit_corners(const std::vector<Following>& all, Moves moves, Visit visit) {
  const std::size_t count = all.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 8 < count) prefetch_vertex(all[i + 8].slot);
    if (i + 4 < count && moves(all[i + 4])) prefetch_corners(all[i + 4].slot);
    if (moves(all[i])) visit(all[i]);
  }
}

// Those that have merged left go into a list of their own: who they are nobody can foretell.
void ActiveCut::part_following() {
  const std::size_t count = following_.size();
  left_.resize(count);
  std::size_t staying = 0, left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 16 < count) __builtin_prefetch(&vertices_[following_[i + 16].slot]);
    const Following f = following_[i];
    const bool stays = vertices_[f.slot].node != kNoNode;
    left_[left] = f;
    following_[staying] = f;
    left += stays ? 0 : 1;
    staying += stays ? 1 : 0;
  }
  left_.resize(left);
  following_.resize(staying);
}

// Vertices stand where they will stay.
void ActiveCut::show_following() {
  constexpr std::size_t kAhead = 4;
  const std::size_t count = following_.size();
  std::array<CompactRanges::Range, kAhead> normals{};  // of the next ones
  for (std::size_t i = 0; i < count + kAhead; ++i) {
    if (i + 20 < count) __builtin_prefetch(&vertices_[following_[i + 20].slot]);
    if (i + 12 < count) prefetch_normals(vertices_[following_[i + 12].slot].node);
    if (i + 8 < count) prefetch_normals_further(vertices_[following_[i + 8].slot].node);
    CompactRanges::Range& range = normals[i % kAhead];
    if (i >= kAhead) show_vertex(following_[i - kAhead].slot, range);
    if (i < count) {
      range = attributes_of_normals(vertices_[following_[i].slot].node);
      prefetch_normal(range.begin);
    }
  }
}

void ActiveCut::forget_following() {
  for (const Following& f : following_) following_of_slot_[f.slot] = kNone;
  for (const Following& f : left_) following_of_slot_[f.slot] = kNone;
  following_.clear();
  left_.clear();
  moves_.clear();
}

void ActiveCut::bring_corners_down() {
  show_following();
  visit_corners(
      following_, [](const Following& f) { return !f.is_new; },
      [&](const Following& f) { give_corners(f.slot); });
  visit_all(following_, [&](const Following& f) { renew_corners(f, f.slot); });
  activate_born();
  for (const SplitId s : moves_) touch_derived(s);
  forget_following();
}

// Those that stand at a vertex which was split, to those that it became.
void ActiveCut::give_corners(std::uint32_t slot) {
  ActiveVertex& v = vertices_[slot];
  lists_.give(v.corners, v.end, [&](const CornerAt& at) {
    const std::uint32_t to = map_.slot_at(at.wedge);
    stand_at(at.corner, to);
    lists_.push_back(vertices_[to].corners, at);
  });
}

// A few splits at a time, each step fetching what the next one reads.
void ActiveCut::activate_born() {
  constexpr std::size_t kAtOnce = 16;
  for (std::size_t first = 0; first < moves_.size(); first += kAtOnce) {
    const std::size_t end = std::min(moves_.size(), first + kAtOnce);
    born_.clear();
    for (std::size_t i = first; i < end; ++i) {
      if (i + 2 * kAtOnce < moves_.size()) {
        h_.triangle_ranges.prefetch(index_of(moves_[i + 2 * kAtOnce]) + 1);
      }
      if (is_large_ && i + kAtOnce < moves_.size()) {
        h_.triangle_ranges.prefetch_further(index_of(moves_[i + kAtOnce]) + 1);
      }
      const TriangleRange range = h_.triangles_of(moves_[i]);
      for (std::uint32_t t = range.begin; t < range.end; ++t) {
        if (is_hidden(TriangleId{t})) continue;
        h_.triangles.of_corner.prefetch(3 * std::size_t(t));
        born_.push_back({TriangleId{t}, {}, {}, {}});
      }
    }
    for (Born& b : born_) {
      b.wedges = h_.triangles[index_of(b.triangle)];
      for (std::size_t k = 0; is_large_ && k < 3; ++k) {
        map_.prefetch(b.wedges[k]);
        prefetch_values(b.wedges[k]);
      }
    }
    for (Born& b : born_) {
      for (std::size_t k = 0; k < 3; ++k) b.begins[k] = map_.begin_before(b.wedges[k]);
      for (std::size_t k = 0; is_large_ && k < 3; ++k) map_.prefetch_slot(b.begins[k]);
    }
    for (Born& b : born_) {
      for (std::size_t k = 0; k < 3; ++k) {
        b.slots[k] = map_.slot_from(b.begins[k]);
        prefetch_vertex(b.slots[k]);
      }
    }
    if (is_large_) prefetch_varying_values();
    for (const Born& b : born_) activate(b.triangle, b.wedges, b.slots);
  }
}

void ActiveCut::bring_corners_up() {
  part_following();
  show_following();
  visit_all(left_, [&](const Following& f) {
    to_of_slot_[f.slot] = map_.slot_at(vertices_[f.slot].begin);
  });
  visit_corners(
      left_, [](const Following&) { return true; },
      [&](const Following& f) {
        lists_.keep_if(vertices_[f.slot].corners,
                       [&](const CornerAt& at) { return goes_up(at.corner); });
      });
  // In lists of those that stay all values are right then.
  visit_all(following_, [&](const Following& f) { renew_corners(f, f.slot); });
  visit_all(left_, [&](const Following& f) { take_corners(f); });
  for (const SplitId s : moves_) touch_derived(s);
  forget_following();
}

// Whether the triangle of a corner at a vertex that is left is still one; the corner stands where
// it belongs then. Else the triangle vanishes, and its other two corners from their lists: also
// from one that is left, where it would be met again.
bool ActiveCut::goes_up(CornerRef corner) {
  ActiveTriangles& part = parts_[corner.part()];
  std::uint32_t* const slots = &part.slots[3 * std::size_t(corner.triangle())];
  const std::uint32_t* const to_of_slot = to_of_slot_.data();
  std::uint32_t to[3];
  for (std::size_t k = 0; k < 3; ++k) to[k] = to_of_slot[slots[k]];
  if ((to[0] != to[1]) & (to[1] != to[2]) & (to[2] != to[0])) {
    slots[corner.corner()] = to[corner.corner()];
    part.moved.mark(corner.triangle());
    return true;
  }
  constexpr std::uint32_t kOthers[3][2] = {{1, 2}, {2, 0}, {0, 1}};
  for (const std::uint32_t k : kOthers[corner.corner()]) {
    lists_.erase(vertices_[slots[k]].corners, CornerRef(corner.part(), corner.triangle(), k));
  }
  part.remove(corner.triangle());
  return false;
}

void ActiveCut::take_corners(const Following& f) {
  const std::uint32_t to = to_of_slot_[f.slot];
  CornerList& list = vertices_[f.slot].corners;
  renew_corners(f, to);
  for (std::uint32_t i = 0; i < list.count; ++i) {
    lists_.push_back(vertices_[to].corners, lists_.of(list)[i]);
  }
  lists_.clear(list);
  to_of_slot_[f.slot] = f.slot;
  free_slots_.push_back(f.slot);
}

// Of the list at f, which comes to `to`.
void ActiveCut::renew_corners(const Following& f, std::uint32_t to) {
  const CornerList& list = vertices_[f.slot].corners;
  const ActiveVertex& v = vertices_[to];
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    if (!has_several(i, v)) continue;
    if (orders_[i].empty()) {
      renew_values(f, v, i);
    } else {
      look_up_values(list, v, i);
    }
  }
  touch_corners(list, f.had_one_normal, v.has_one_normal());
}

// Of the corners at a vertex that has moved those whose triangle may have another kind or shading.
// Values have been looked after.
void ActiveCut::touch_corners(const CornerList& list, bool had_one_normal, bool has_one_normal) {
  if (!touches_triangles_) return;
  const bool only_derived = !has_one_normal && !had_one_normal;
  if (only_derived && !is_painted() && normal_layer_ != kNone && h_.deriving_splits.empty()) {
    return;
  }
  const bool needs_derived = only_derived && !is_painted();
  const auto touch = [&](CornerRef corner) {
    ActiveTriangles& part = parts_[corner.part()];
    const bool is_derived = part.is_derived[corner.triangle()] != 0;
    part.touched.mark_if(corner.triangle(),
                         !needs_derived | is_derived | (corner.part() == kSnPart));
  };
  const bool only_others = has_one_normal && !is_painted();
  if (!list.is_own()) {
    for (const CornerAt at : lists_.of(list)) {
      if (!only_others || at.corner.part() != kSnPart) touch(at.corner);
    }
    return;
  }
  std::uint32_t left = only_others ? list.of_other_parts(kSnPart) : list.all();
  for (; left != 0; left &= left - 1) {
    touch(list.refs[static_cast<std::size_t>(std::countr_zero(left))]);
  }
}

}  // namespace crease

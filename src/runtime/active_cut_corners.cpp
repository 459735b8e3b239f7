// Corners, which follow vertices that have moved.
#include "runtime/active_cut.h"

#include <algorithm>
#include <array>
#include <bit>

namespace crease {

// With the memory of the next ones on its way.
template <typename Visit>
void ActiveCut::visit_following(Visit visit) {
  const std::size_t count = following_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 8 < count) prefetch_vertex(following_[i + 8].slot);
    visit(following_[i]);
  }
}

// The same for those of which moves(f) holds, with that of the triangles of their corners.
template <typename Moves, typename Visit>
void ActiveCut::visit_corners_following(Moves moves, Visit visit) {
  const std::size_t count = following_.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 8 < count) prefetch_vertex(following_[i + 8].slot);
    if (i + 4 < count && moves(following_[i + 4])) prefetch_corners(following_[i + 4].slot);
    if (moves(following_[i])) visit(following_[i]);
  }
}

// Vertices stand where they will stay. Those that have merged left tell where their corners go.
void ActiveCut::show_following() {
  constexpr std::size_t kAhead = 4;
  const std::size_t count = following_.size();
  const auto normals_of = [&](std::size_t i) {
    return attributes_of_normals(vertices_[following_[i].slot].node);
  };
  std::array<CompactRanges::Range, kAhead> normals{};  // of the next ones
  for (std::size_t i = 0; i < count + kAhead; ++i) {
    if (i + 20 < count) __builtin_prefetch(&vertices_[following_[i + 20].slot]);
    if (i + 12 < count) prefetch_normals(vertices_[following_[i + 12].slot].node);
    if (i + 8 < count) prefetch_normals_further(vertices_[following_[i + 8].slot].node);
    CompactRanges::Range& range = normals[i % kAhead];
    if (i >= kAhead) {
      const std::uint32_t slot = following_[i - kAhead].slot;
      if (vertices_[slot].node != kNoNode) {
        show_vertex(slot, range);
      } else {
        to_of_slot_[slot] = map_.slot_at(vertices_[slot].begin);
      }
    }
    if (i < count) {
      range = normals_of(i);
      prefetch_normal(range.begin);
    }
  }
}

void ActiveCut::forget_following() {
  for (const Following& f : following_) following_of_slot_[f.slot] = kNone;
  following_.clear();
  moves_.clear();
}

void ActiveCut::bring_corners_down() {
  show_following();
  visit_corners_following([](const Following& f) { return !f.is_new; },
                          [&](const Following& f) { give_corners(f.slot); });
  visit_following([&](const Following& f) { renew_corners(f, f.slot); });
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
      for (std::size_t k = 0; k < 3; ++k) {
        map_.prefetch(b.wedges[k]);
        prefetch_values(b.wedges[k]);
      }
    }
    for (Born& b : born_) {
      for (std::size_t k = 0; k < 3; ++k) {
        b.begins[k] = map_.begin_before(b.wedges[k]);
        map_.prefetch_slot(b.begins[k]);
      }
    }
    for (Born& b : born_) {
      for (std::size_t k = 0; k < 3; ++k) {
        b.slots[k] = map_.slot_from(b.begins[k]);
        prefetch_vertex(b.slots[k]);
      }
    }
    for (const Born& b : born_) activate(b.triangle, b.wedges, b.slots);
  }
}

void ActiveCut::bring_corners_up() {
  show_following();
  visit_corners_following([&](const Following& f) { return is_left(f.slot); },
                          [&](const Following& f) {
                            lists_.keep_if(vertices_[f.slot].corners,
                                           [&](const CornerAt& at) { return goes_up(at.corner); });
                          });
  visit_following(
      [&](const Following& f) {  // in lists of those that stay all values are right then
        if (!is_left(f.slot)) renew_corners(f, f.slot);
      });
  visit_following([&](const Following& f) {
    if (is_left(f.slot)) take_corners(f);
  });
  for (const SplitId s : moves_) touch_derived(s);
  forget_following();
}

// Whether the triangle of a corner at a vertex that is left is still one; the corner stands where
// it belongs then. Else it vanishes from the lists that stay.
bool ActiveCut::goes_up(CornerRef corner) {
  ActiveTriangles& part = parts_[corner.part()];
  std::uint32_t* const slots = &part.slots[3 * std::size_t(corner.triangle())];
  std::uint32_t to[3];
  for (std::size_t k = 0; k < 3; ++k) to[k] = to_of_slot_[slots[k]];
  if ((to[0] != to[1]) & (to[1] != to[2]) & (to[2] != to[0])) {
    slots[corner.corner()] = to[corner.corner()];
    part.moved.mark(corner.triangle());
    return true;
  }
  if (part.ids[corner.triangle()] == kNoTriangle) return false;
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (is_left(slots[k])) continue;
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

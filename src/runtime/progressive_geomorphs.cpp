// Levels that are seen as geomorphs.
#include "runtime/progressive_impl.h"

#include <map>

namespace crease {

// What a coarser level will show, and of which slots and normals.
struct ProgressiveMesh::Impl::Looked {
  Impl& mesh;
  std::map<std::uint32_t, std::uint32_t> becomes;  // slots by contraction: one by one
  std::map<std::uint32_t, Vec3f> positions, own_normals;
  std::array<std::map<std::uint32_t, Vec3f>, kSectionCount> normals;  // numbered as in the part

  void position(std::uint32_t slot) { positions[slot]; }
  void own_normal(std::uint32_t slot) { own_normals[slot]; }
  void corner(std::uint32_t c) { touched(c); }
  void index(std::uint32_t layer, std::uint32_t c) {
    if (layer == 0) changes(c / 3);
  }
  void derived(std::uint32_t t) { changes(t); }
  void touched(std::uint32_t c) {
    if (mesh.state.is_derived(c / 3)) changes(c / 3);
  }
  void changes(std::uint32_t t) {
    const TrianglePart& part = mesh.part_of(t);
    const auto s = static_cast<std::size_t>(&part - mesh.parts.data());
    for (std::uint32_t k = 0; k < part.normals_per_triangle; ++k) {
      normals[s][(t - part.first) * part.normals_per_triangle + k];
    }
  }
  std::uint32_t last(std::uint32_t slot) const {
    for (auto next = becomes.find(slot); next != becomes.end(); next = becomes.find(slot)) {
      slot = next->second;
    }
    return slot;
  }
};

namespace {

// The slot that is no longer active at the coarser one of two levels, one contraction apart.
std::uint32_t removed_slot(const ProgressiveArrays& arrays, const SectionCounts& finer,
                           const SectionCounts& coarser) {
  return coarser.nsn_vertices < finer.nsn_vertices ? arrays.full.sn_vertices + coarser.nsn_vertices
                                                   : coarser.sn_vertices;
}

}  // namespace

bool ProgressiveMesh::Impl::is_moving() const {
  return is_coarsening() || !position_ways.empty() || !own_normal_ways.empty() ||
         !parts[kFn].ways.empty() || !parts[kNsn].ways.empty();
}

void ProgressiveMesh::Impl::want(std::size_t count) {
  wanted = count;
  if (is_coarsening() && wanted < taken_at) turn_back();
  if (!is_coarsening()) {
    if (wanted < state.applied()) go_finer(wanted);
    if (wanted > state.applied()) go_coarser();
  }
  arrive();
}

// Time that has no end would be no number any more.
static constexpr double kLongestStep = 1e6;

void ProgressiveMesh::Impl::advance(double passed) {
  if (passed > 0) now += std::min(passed, kLongestStep);  // what is no number is none
  mark_moving();
  if (is_coarsening() && now - began_leaving >= seconds) {
    take_coarser();
    if (wanted > state.applied()) go_coarser();
  }
  arrive();
  forget_arrived();
}

// Each vertex that comes out of another one starts where that was seen.
void ProgressiveMesh::Impl::go_finer(std::size_t count) {
  if (seconds <= 0) {
    move_to(count);
    taken_at = state.applied();
    return;
  }
  Marks marks{*this};
  std::map<std::uint32_t, Vec3f> from, normal_from;
  while (state.applied() > count) {
    const SectionCounts coarser = state.active();
    const std::uint32_t kept = arrays->contractions.kept[state.applied() - 1];
    const Vec3f at = from.try_emplace(kept, positions[kept]).first->second;
    const bool has_normal = kept < arrays->full.sn_vertices;
    if (has_normal) normal_from.try_emplace(kept, own_normals[kept]);
    state.undo(marks);
    const std::uint32_t removed = removed_slot(*arrays, state.active(), coarser);
    from[removed] = at;
    position_ways.erase(removed);
    position_changes.mark(removed);
    if (removed >= arrays->full.sn_vertices) continue;
    own_normal_ways.erase(removed);
    own_normal_changes.mark(removed);
    if (has_normal) normal_from[removed] = normal_from[kept];
  }
  for (const auto& [slot, place] : from) {
    position_ways.set(slot, own_position(slot), {place, own_position(slot), now});
    position_changes.mark(slot);
  }
  for (const auto& [slot, normal] : normal_from) {
    const Vec3f& own = state.own_normals[slot];
    own_normal_ways.set(slot, own, {normal, own, now});
    own_normal_changes.mark(slot);
  }
  taken_at = state.applied();
}

void ProgressiveMesh::Impl::look_at(std::size_t count, Looked& looked) {
  const std::size_t before = state.applied();
  while (state.applied() < count) {
    const SectionCounts finer = state.active();
    const std::uint32_t kept = arrays->contractions.kept[state.applied()];
    state.apply(looked);
    const std::uint32_t removed = removed_slot(*arrays, finer, state.active());
    looked.becomes[removed] = kept;
    looked.position(removed);
    looked.position(kept);
    if (removed < arrays->full.sn_vertices) looked.own_normal(removed);
  }
  wanted_triangles = state.active().triangles();
  for (auto& [slot, place] : looked.positions) place = own_position(looked.last(slot));
  for (auto& [slot, normal] : looked.own_normals) {
    const std::uint32_t last = looked.last(slot);
    if (last < arrays->full.sn_vertices) normal = state.own_normals[last];
  }
  for (const int s : {kFn, kNsn}) {
    const TrianglePart& part = parts[s];
    const std::uint32_t each = part.normals_per_triangle;
    for (auto& [i, normal] : looked.normals[s]) {
      if (i / each < active_of(s)) normal = shown_normal(3 * (part.first + i / each) + i % each);
    }
  }
  NoMarks none;
  while (state.applied() > before) state.undo(none);
}

// What has no place at the coarser level vanishes with it.
void ProgressiveMesh::Impl::go_coarser() {
  if (seconds <= 0) {
    move_to(wanted);
    taken_at = state.applied();
    return;
  }
  Looked looked{*this, {}, {}, {}, {}};
  look_at(wanted, looked);
  taken_at = wanted;
  began_leaving = now;
  for (const auto& [slot, place] : looked.positions) {
    position_ways.set(slot, own_position(slot), {shown_position(slot), place, now, true});
    position_changes.mark(slot);
  }
  for (const auto& [slot, normal] : looked.own_normals) {
    if (normal == Vec3f{}) continue;
    own_normal_ways.set(slot, state.own_normals[slot], {shown_own_normal(slot), normal, now, true});
    own_normal_changes.mark(slot);
  }
  for (const int s : {kFn, kNsn}) {
    TrianglePart& part = parts[s];
    const std::uint32_t each = part.normals_per_triangle;
    for (const auto& [i, normal] : looked.normals[s]) {
      if (i / each >= active_of(s) || normal == Vec3f{}) continue;
      const Vec3f own = shown_normal(3 * (part.first + i / each) + i % each);
      part.ways.set(i, own, {part.normals[i], normal, now, true});
      part.normal_changes.mark(i / each);
    }
  }
}

void ProgressiveMesh::Impl::turn_back() {
  taken_at = state.applied();
  const auto turn = [this](Ways& ways, auto own_of) {
    std::map<std::uint32_t, Vec3f> from;
    ways.visit_and_erase([&](std::uint32_t i, const Way& way) {
      if (way.is_leaving) from[i] = ways.shown(way, now, seconds);
      return false;
    });
    for (const auto& [i, at] : from) {
      const Vec3f own = own_of(i);
      ways.set(i, own, {at, own, now});
    }
  };
  turn(position_ways, [this](std::uint32_t slot) { return own_position(slot); });
  turn(own_normal_ways, [this](std::uint32_t slot) { return state.own_normals[slot]; });
  for (const int s : {kFn, kNsn}) {
    const TrianglePart& part = parts[s];
    const std::uint32_t each = part.normals_per_triangle;
    turn(parts[s].ways,
         [&](std::uint32_t i) { return shown_normal(3 * (part.first + i / each) + i % each); });
  }
}

// Everything is where the coarser level has it.
void ProgressiveMesh::Impl::take_coarser() {
  const auto is_leaving = [](std::uint32_t, const Way& way) { return way.is_leaving; };
  position_ways.visit_and_erase(is_leaving);
  own_normal_ways.visit_and_erase(is_leaving);
  for (const int s : {kFn, kNsn}) {
    parts[s].ways.visit_and_erase([&](std::uint32_t i, const Way& way) {
      if (way.is_leaving) parts[s].normals[i] = way.to;
      return way.is_leaving;
    });
  }
  move_to(taken_at);
}

void ProgressiveMesh::Impl::mark_moving() {
  position_ways.visit_and_erase([this](std::uint32_t slot, const Way&) {
    position_changes.mark(slot);
    return false;
  });
  own_normal_ways.visit_and_erase([this](std::uint32_t slot, const Way&) {
    own_normal_changes.mark(slot);
    return false;
  });
  for (const int s : {kFn, kNsn}) {
    TrianglePart& part = parts[s];
    part.ways.visit_and_erase([&](std::uint32_t i, const Way&) {
      part.normal_changes.mark(i / part.normals_per_triangle);
      return i / part.normals_per_triangle >= active_of(s);
    });
  }
}

void ProgressiveMesh::Impl::forget_arrived() {
  for (Ways* const ways : {&position_ways, &own_normal_ways, &parts[kFn].ways, &parts[kNsn].ways}) {
    ways->visit_and_erase([this](std::uint32_t, const Way& way) {
      return !way.is_leaving && now - way.began >= seconds;
    });
  }
}

}  // namespace crease

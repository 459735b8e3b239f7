// Moves that are seen as geomorphs: splits start where the vertex was, merges wait for theirs.
#include "hierarchy/grid_sum.h"
#include "runtime/refiner.h"

namespace crease {

std::uint32_t Refiner::move_down(ActiveCut& cut, std::uint32_t slot) {
  ++report_.splits;
  if (at_once_) return cut.split_vertex(slot);
  if (geomorphs_ == nullptr) return cut.split(slot);
  const SplitId s = cut.vertices()[slot].split;
  geomorphs_->before_split(cut, slot);
  const std::uint32_t other = cut.split(slot);
  geomorphs_->after_split(cut, s, slot, other);
  return other;
}

void Refiner::move_up(ActiveCut& cut, SplitId s, const ActiveCut::Children& children) {
  ++report_.merges;
  if (at_once_) return cut.merge_vertices(s, children);
  cut.merge(s, children);
  if (geomorphs_ != nullptr) geomorphs_->merged(s, children);
}

// Something that is to be merged goes there first, if it is seen.
bool Refiner::waits(const ActiveCut& cut, SplitId s, const ActiveCut::Children& children,
                    bool for_room) {
  if (geomorphs_ == nullptr || !geomorphs_->is_on()) return false;
  if (geomorphs_->is_leaving(s, children)) return true;
  const std::uint32_t slot = children.first != kNoSlot ? children.first : children.second;
  if (slot == kNoSlot) return false;
  if (has_view_) {
    const ActiveVertex& v = cut.vertices()[slot];
    const VertexHierarchy& h = cut.hierarchy().vertices;
    const Vec3f at = error_.position(grid_difference(v.position, h.delta_of(v.node)));
    if (error_.inside(at.x, at.y, at.z) + bounds_of(cut, s).radius.value() < 0) return false;
  }
  return geomorphs_->leave(cut, s, children, for_room);
}

// What was on its way to be merged and is seen to be wrong now.
void Refiner::turn_back(const ActiveCut& cut) {
  if (geomorphs_ == nullptr) return;
  for (const Geomorphs::Leaving& l : geomorphs_->all_leaving()) {
    if (l.for_room) continue;
    if (excess_above(cut, cut.vertices()[l.slot], l.split) > 1) geomorphs_->stay(cut, l.split);
  }
}

bool Refiner::merge_arrived(ActiveCut& cut) {
  if (geomorphs_ == nullptr) return false;
  bool has_any = false;
  for (const Geomorphs::Leaving& l : geomorphs_->all_leaving()) {
    if (!l.has_arrived || out_of_time()) continue;
    has_any = true;
    if (is_needed(cut, l.split)) {
      geomorphs_->stay(cut, l.split);
    } else if (cut.can_merge(l.split)) {
      merge(cut, l.split, cut.children(l.split));
    }
  }
  return has_any;
}

}  // namespace crease

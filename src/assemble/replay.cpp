#include "assemble/replay.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace crease {

Replay::Replay(const Mesh& snapped, const ContractionSequence& sequence)
    : mesh_(snapped), sequence_(sequence) {
  const std::size_t vertex_count = snapped.vertex_count();
  const std::size_t triangle_count = snapped.triangle_count();
  corners_.resize(3 * triangle_count);
  first_corner_.assign(vertex_count, kNone);
  valence_.assign(vertex_count, 0);
  for (std::size_t corner = corners_.size(); corner-- > 0;) {  // so that chains are ascending
    const auto slot =
        static_cast<std::uint32_t>(index_of(snapped.triangles[corner / 3][corner % 3]));
    corners_[corner] = {slot, first_corner_[slot]};
    first_corner_[slot] = static_cast<std::uint32_t>(corner);
    ++valence_[slot];
  }
  for (const AttributeLayer& layer : snapped.layers) of_corner_.push_back(layer.of_corner);
  derived_.assign(triangle_count, 0);
  positions_.reserve(vertex_count);
  for (const Vec3d& p : snapped.positions) positions_.push_back(sequence.grid.nearest(p));
  slot_of_vertex_.resize(vertex_count);
  std::iota(slot_of_vertex_.begin(), slot_of_vertex_.end(), 0u);
  vertex_of_slot_ = slot_of_vertex_;
  last_use_.assign(vertex_count, 0);
  for (std::size_t i = 0; i < sequence.contractions.size(); ++i) {
    const Contraction& c = sequence.contractions[i];
    last_use_[index_of(c.removed)] = last_use_[index_of(c.kept)] = static_cast<std::uint32_t>(i);
  }
}

void Replay::gather(std::uint32_t slot, std::uint32_t other, std::vector<std::uint32_t>& corners,
                    std::vector<std::uint32_t>* lost) {
  corners.clear();
  for (std::uint32_t corner = first_corner_[slot]; corner != kNone;
       corner = corners_[corner].next) {
    const std::uint32_t t = corner / 3;
    const Corner* of_t = &corners_[3 * std::size_t(t)];
    if (of_t[0].slot == kDead) continue;
    if (of_t[0].slot != other && of_t[1].slot != other && of_t[2].slot != other) {
      corners.push_back(corner);
    } else if (lost != nullptr) {
      lost->push_back(t);
    }
  }
}

const Step& Replay::look(std::uint32_t contraction) {
  const Contraction& c = sequence_.contractions[contraction];
  step_.p_slot = slot_of_vertex_[index_of(c.removed)];
  step_.q_slot = slot_of_vertex_[index_of(c.kept)];
  step_.lost.clear();
  gather(step_.p_slot, step_.q_slot, step_.at_p, &step_.lost);
  gather(step_.q_slot, step_.p_slot, step_.at_q, nullptr);
  for (auto* list : {&step_.at_p, &step_.at_q, &step_.lost}) std::sort(list->begin(), list->end());
  return step_;
}

void Replay::drop_lost(std::uint32_t contraction) {
  lost_slots_.clear();
  for (std::uint32_t t : step_.lost) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t slot = std::exchange(corners_[3 * std::size_t(t) + c].slot, kDead);
      --valence_[slot];
      if (slot == step_.p_slot || slot == step_.q_slot || valence_[slot] != 0) continue;
      if (last_use_[vertex_of_slot_[slot]] <= contraction) lost_slots_.push_back(slot);
    }
  }
  std::sort(lost_slots_.begin(), lost_slots_.end());
}

void Replay::move_corners(std::uint32_t kept, std::uint32_t removed) {
  std::uint32_t chain = kNone;
  for (const std::vector<std::uint32_t>* corners : {&step_.at_q, &step_.at_p}) {
    for (std::uint32_t corner : *corners) {
      corners_[corner] = {kept, chain};
      chain = corner;
    }
  }
  first_corner_[kept] = chain;
  first_corner_[removed] = kNone;
  valence_[kept] += valence_[removed];
  valence_[removed] = 0;
}

}  // namespace crease

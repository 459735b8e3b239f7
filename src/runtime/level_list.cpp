#include "runtime/level_list.h"

#include "runtime/cut_drawing.h"
#include "runtime/geomorphs.h"
#include "runtime/group_by_place.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>

namespace crease {

namespace {

// Copies the triangles of a draw list, group by group, and what they use.
class ListMaker {
 public:
  ListMaker(const DrawList& from, LevelList& to) : from_(from), to_(to) {
    first_ = {0, from.sn.triangle_count(), from.sn.triangle_count() + from.fn.triangle_count()};
  }

  void run() {
    number_vertices();
    std::vector<std::uint32_t> order(first_[2] + from_.nsn.triangle_count());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    if (order.empty()) return;
    std::vector<std::size_t> ends;
    group_by_place(
        order, 0, order.size(), [this](std::uint32_t t) { return place_of(t); }, ends);
    for (std::size_t begin = 0, g = 0; g < ends.size(); begin = ends[g++]) {
      const Vec3f& first = from_.positions[indices_of(order[begin])[0]];
      BlockGroup group{0, next(to_.sn), next(to_.fn), next(to_.nsn), first, first};
      for (std::size_t i = begin; i < ends[g]; ++i) add(order[i], group);
      to_.groups.push_back(group);
    }
    to_.groups.shrink_to_fit();
  }
  // Of each part, which one of the other list its triangles are.
  const std::array<std::vector<std::uint32_t>, 3>& sources() const { return sources_; }

 private:
  std::size_t part_of(std::uint32_t t) const { return t < first_[1] ? 0 : t < first_[2] ? 1 : 2; }
  const DrawPart& part(std::size_t p) const {
    return p == 0 ? from_.sn : p == 1 ? from_.fn : from_.nsn;
  }
  std::span<const std::uint32_t> indices_of(std::uint32_t t) const {
    const std::size_t p = part_of(t);
    return part(p).indices.subspan(3 * (t - first_[p]), 3);
  }
  std::array<float, 3> place_of(std::uint32_t t) const {
    std::array<float, 3> sum{};
    for (const std::uint32_t v : indices_of(t)) {
      const Vec3f& p = from_.positions[v];
      sum = {sum[0] + p.x, sum[1] + p.y, sum[2] + p.z};
    }
    return sum;
  }
  static Range next(const BlockPart& part) {
    return {static_cast<std::uint32_t>(part.indices.size() / 3), 0};
  }

  // Those that show normals of vertices first.
  void number_vertices() {
    number_.assign(from_.positions.size(), kNone);
    for (std::size_t p = 0; p < 3; ++p) {
      for (const std::uint32_t v : part(p).indices) {
        if (number_[v] != kNone) continue;
        number_[v] = static_cast<std::uint32_t>(to_.positions.size());
        to_.positions.push_back(from_.positions[v]);
        if (p == 0) to_.vertex_normals.push_back(from_.vertex_normals[v]);
      }
    }
    to_.positions.shrink_to_fit();
    to_.vertex_normals.shrink_to_fit();
    const auto reserve = [](const DrawPart& like, BlockPart& part) {
      part.indices.reserve(like.indices.size());
      part.normals.reserve(like.normals.size());
      part.materials.reserve(like.materials.size());
      part.colors.reserve(like.colors.size());
      part.texcoords.reserve(like.texcoords.size());
    };
    reserve(from_.sn, to_.sn);
    reserve(from_.fn, to_.fn);
    reserve(from_.nsn, to_.nsn);
  }

  void add(std::uint32_t t, BlockGroup& group) {
    const std::size_t p = part_of(t), own = t - first_[p];
    const DrawPart& from = part(p);
    BlockPart& to = p == 0 ? to_.sn : p == 1 ? to_.fn : to_.nsn;
    ++(p == 0 ? group.sn : p == 1 ? group.fn : group.nsn).count;
    sources_[p].push_back(static_cast<std::uint32_t>(own));
    for (const std::uint32_t v : indices_of(t)) {
      to.indices.push_back(number_[v]);
      const Vec3f& at = from_.positions[v];
      group.low = {std::min(group.low.x, at.x), std::min(group.low.y, at.y),
                   std::min(group.low.z, at.z)};
      group.high = {std::max(group.high.x, at.x), std::max(group.high.y, at.y),
                    std::max(group.high.z, at.z)};
    }
    const auto copy = [own](const auto& all, auto& copied, std::size_t each) {
      for (std::size_t k = 0; k < each && !all.empty(); ++k) copied.push_back(all[each * own + k]);
    };
    copy(from.normals, to.normals, p == 2 ? 3 : p);
    copy(from.materials, to.materials, 1);
    copy(from.colors, to.colors, 3);
    copy(from.texcoords, to.texcoords, 3);
  }

  const DrawList& from_;
  LevelList& to_;
  std::array<std::size_t, 3> first_{};  // per part, of all triangles
  std::vector<std::uint32_t> number_;   // per position
  std::array<std::vector<std::uint32_t>, 3> sources_;
};

// Of all lists of the program.
std::uint64_t next_list() {
  static std::atomic<std::uint64_t> last{std::uint64_t(1) << 63};  // other than those of cuts
  return ++last;
}

}  // namespace

void split_as(const LevelList& list, ActiveCut& cut) {
  const auto is_done = [&list](SplitId s) {
    return (list.done[index_of(s) / 64] >> (index_of(s) % 64) & 1) != 0;
  };
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < cut.vertices().size(); ++slot) {
    if (cut.vertices()[slot].node != kNoNode) slots.push_back(slot);
  }
  while (!slots.empty()) {
    const std::uint32_t slot = slots.back();
    const SplitId s = cut.vertices()[slot].split;
    if (s == kNoSplit || !is_done(s)) {
      slots.pop_back();
      continue;
    }
    const std::uint32_t second = cut.split(slot);
    if (second != kNoSlot) slots.push_back(second);
  }
}

LevelListPtr make_level_list(const ResidentBlock::Data& block, const BlockHierarchy::Data& data,
                             int level, std::vector<std::uint64_t> done) {
  auto list = std::make_shared<LevelList>();
  list->level = level;
  list->done = std::move(done);
  ActiveCut cut(data.hierarchy);
  split_as(*list, cut);
  const Geomorphs at_rest(data.hierarchy);
  CutDrawing drawing;
  drawing.arrive(cut, at_rest);
  const DrawList drawn = drawing.draw_list(cut);
  ListMaker maker(drawn, *list);
  maker.run();
  const std::uint32_t parts = block.schema->coding.part_count;
  BlockPart* const lists[] = {&list->sn, &list->fn, &list->nsn};
  for (std::size_t p = 0; p < 3 && parts > 1; ++p) {
    lists[p]->parts = PackedIndices<>(bits_for(parts));
    for (const std::uint32_t t : maker.sources()[p]) {
      const std::uint32_t triangle = data.triangle_of[index_of(cut.parts()[p].ids[t])];
      lists[p]->parts.push_back(block.end.category(triangle) / block.schema->coding.material_count);
    }
  }
  list->revision = next_list();
  return list;
}

std::size_t LevelList::bytes() const {
  return sizeof(*this) + 8 * done.capacity() +
         sizeof(Vec3f) * (positions.capacity() + vertex_normals.capacity()) + sn.bytes() +
         fn.bytes() + nsn.bytes() + sizeof(BlockGroup) * groups.capacity();
}

}  // namespace crease

#include "runtime/block_levels.h"

#include "runtime/active_cut.h"
#include "runtime/block_errors.h"
#include "runtime/cut_drawing.h"
#include "runtime/geomorphs.h"
#include "runtime/group_by_place.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>

namespace crease {

namespace {

float largest(const LevelError& error) {
  return std::max(error.surface, error.line);
}

std::uint64_t key_of(const codec::VertexName& name) {
  return std::uint64_t(name.block) << 32 | name.vertex;
}

// Of the vertices of the fine end, what finer blocks know of them.
void tighten(const BlockLevelsJob::Data& job, BlockErrors& errors) {
  if (job.finer.empty()) return;
  const KeptEnd& end = job.block->data().end;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_name;
  for (std::uint32_t v = 0; v < end.vertex_count(); ++v) vertex_of_name[key_of(end.name(v))] = v;
  for (const BlockLevelsJob::Data::Finer& finer : job.finer) {
    const KeptNames& names = finer.block->data().root_names;
    for (std::size_t r = 0; r < finer.facts->of_root.size(); ++r) {
      const auto at = vertex_of_name.find(key_of(names[r]));
      if (at != vertex_of_name.end()) errors.tighten(at->second, finer.facts->of_root[r]);
    }
  }
}

// A split is done from the first level on that leaves less than its error.
class Levels {
 public:
  Levels(const BlockFacts& facts, std::span<const SplitBounds> bounds) : bounds_(bounds) {
    for (int k = 0; k < kFullLevel; ++k) {
      limit_[k] = largest(facts.coarse) * static_cast<float>(std::pow(kLevelRatio, k));
    }
  }
  bool is_done(std::size_t split, int level) const {
    return level > 0 && largest(bounds_[split].error()) > limit_[level];
  }
  LevelError left_by(int level) const {
    LevelError left;
    for (std::size_t s = 0; s < bounds_.size(); ++s) {
      if (!is_done(s, level)) left = larger(left, bounds_[s].error());
    }
    return left;
  }

 private:
  std::span<const SplitBounds> bounds_;
  std::array<float, kFullLevel> limit_{};
};

// Halves the splits of roots, across the longest side, a few times: an error in one corner of a
// block does not matter where only another one is near, or in view.
class PieceMaker {
 public:
  PieceMaker(const BlockHierarchy::Data& data, const Grid& grid, const Levels& levels,
             std::span<const SplitBounds> bounds, LevelFacts& facts)
      : h_(data.hierarchy.vertices), levels_(levels), bounds_(bounds), facts_(facts) {
    for (std::uint32_t s = 0; s < data.root_of_split.size(); ++s) order_.push_back(s);
    for (std::size_t s = 0; s < h_.split_count(); ++s) {
      const NodeId node = h_.node_of_split[s];
      const Vec3i& p = h_.position_of(node);
      place_.push_back({static_cast<float>(grid.step * p.x), static_cast<float>(grid.step * p.y),
                        static_cast<float>(grid.step * p.z)});
      root_split_.push_back(h_.is_root(node) ? std::uint32_t(s)
                                             : root_split_[index_of(h_.split_above(node))]);
    }
  }
  void run() {
    if (!order_.empty()) halve(0, order_.size(), kHalvings);
    std::vector<std::uint32_t> piece_of_root(order_.size());
    for (std::uint32_t piece = 0; piece < ends_.size(); ++piece) {
      for (std::size_t i = piece == 0 ? 0 : ends_[piece - 1]; i < ends_[piece]; ++i) {
        piece_of_root[order_[i]] = piece;
      }
    }
    const std::size_t count = ends_.size();
    for (int k = 1; k < kFullLevel; ++k) {
      for (std::size_t i = 0; i < count; ++i) facts_.pieces.push_back(facts_.pieces[i]);
    }
    for (std::size_t s = 0; s < bounds_.size(); ++s) {
      for (int k = 0; k < kFullLevel; ++k) {
        if (levels_.is_done(s, k)) continue;
        const std::size_t first = static_cast<std::size_t>(k) * count;
        hold(bounds_[s], facts_.pieces[first + piece_of_root[root_split_[s]]].left);
      }
    }
  }

 private:
  static constexpr int kHalvings = 3;

  static void hold(const SplitBounds& error, SplitBounds& worst) {
    const auto raise = [](RoundedUp& to, RoundedUp by) { to = by.bits > to.bits ? by : to; };
    raise(worst.surface, error.surface);
    raise(worst.line, error.line);
    raise(worst.degrees, error.degrees);
    raise(worst.texture, error.texture);
  }
  static float along(const Vec3f& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

  void halve(std::size_t begin, std::size_t end, int halvings) {
    Vec3f low = place_[order_[begin]], high = low;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& p = place_[order_[i]];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    if (halvings == 0 || end - begin < 2) return add_piece(begin, end, (low + high) * 0.5f);
    const Vec3f size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto at = [this](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      const float x = along(place_[a], axis), y = along(place_[b], axis);
      return x != y ? x < y : a < b;
    });
    halve(begin, middle, halvings - 1);
    halve(middle, end, halvings - 1);
  }

  // The spheres of roots hold those below.
  void add_piece(std::size_t begin, std::size_t end, const Vec3f& center) {
    float radius = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const float own = bounds_[order_[i]].radius.value();
      radius = std::max(radius, length(place_[order_[i]] - center) * 1.00001f + own);
    }
    LevelPiece piece;
    piece.center = center;
    piece.left.radius = RoundedUp::from(radius);
    facts_.pieces.push_back(piece);
    ends_.push_back(end);
  }

  const VertexHierarchy& h_;
  const Levels& levels_;
  std::span<const SplitBounds> bounds_;
  LevelFacts& facts_;
  std::vector<std::uint32_t> order_;       // splits of roots, which are the first ones
  std::vector<Vec3f> place_;               // per split
  std::vector<std::uint32_t> root_split_;  // per split: the one of its root
  std::vector<std::size_t> ends_;          // per piece, in order_
};

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

LevelListPtr make_list(const ResidentBlock::Data& block, const BlockHierarchy::Data& data,
                       const Levels& levels, int level) {
  auto list = std::make_shared<LevelList>();
  list->level = level;
  const std::size_t splits = data.hierarchy.vertices.split_count();
  list->done.assign(splits / 64 + 1, 0);
  for (std::size_t s = 0; s < splits; ++s) {
    if (levels.is_done(s, level)) list->done[s / 64] |= std::uint64_t(1) << (s % 64);
  }
  ActiveCut cut(data.hierarchy);
  split_as(*list, cut);
  const Geomorphs at_rest(data.hierarchy);
  CutDrawing drawing;
  drawing.arrive(cut, at_rest);
  const DrawList drawn = drawing.draw_list(cut);
  ListMaker maker(drawn, *list);
  maker.run();
  const std::uint32_t parts = block.schema->coding.part_count;
  for (std::size_t p = 0; p < 3 && parts > 0; ++p) {
    list->part_of_triangle[p] = PackedIndices<>(bits_for(parts));
    for (const std::uint32_t t : maker.sources()[p]) {
      const std::uint32_t triangle = data.triangle_of[index_of(cut.parts()[p].ids[t])];
      list->part_of_triangle[p].push_back(block.end.category(triangle) /
                                          block.schema->coding.material_count);
    }
  }
  list->revision = next_list();
  return list;
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

std::size_t LevelList::bytes() const {
  std::size_t bytes = sizeof(*this) + 8 * done.capacity() +
                      sizeof(Vec3f) * (positions.capacity() + vertex_normals.capacity()) +
                      sn.bytes() + fn.bytes() + nsn.bytes() +
                      sizeof(BlockGroup) * groups.capacity();
  for (const PackedIndices<>& parts : part_of_triangle) bytes += parts.bytes();
  return bytes;
}

BlockLevels::BlockLevels(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
BlockLevels::~BlockLevels() = default;

BlockId BlockLevels::id() const {
  return data_->id;
}

BlockLevelsJob::BlockLevelsJob(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
BlockLevelsJob::~BlockLevelsJob() = default;
BlockLevelsJob::BlockLevelsJob(BlockLevelsJob&&) noexcept = default;

BlockId BlockLevelsJob::id() const {
  return data_->block->id();
}

BlockLevelsPtr BlockLevelsJob::run() const {
  const BlockHierarchyPtr hierarchy = BlockHierarchyJob(data_->block, data_->needed).run();
  const BlockHierarchy::Data& data = hierarchy->data();
  auto result = std::make_unique<BlockLevels::Data>();
  auto facts = std::make_shared<LevelFacts>();
  result->id = id();
  if (!data.is_empty) {
    BlockErrors errors(data);
    tighten(*data_, errors);
    errors.settle();
    const Levels levels(data_->block->facts(), errors.bounds());
    for (int k = 0; k < kFullLevel; ++k) facts->left[k] = levels.left_by(k);
    for (std::uint32_t r = 0; r < data.node_of_root.size(); ++r) {
      facts->of_root.push_back(errors.of_root(r));
    }
    const Grid& grid = data_->block->data().schema->facts.grid;
    PieceMaker(data, grid, levels, errors.bounds(), *facts).run();
    if (data_->level > 0 && data_->level < kFullLevel) {
      result->list = make_list(data_->block->data(), data, levels, data_->level);
    }
  }
  result->facts = std::move(facts);
  return std::make_shared<const BlockLevels>(std::move(result));
}

}  // namespace crease

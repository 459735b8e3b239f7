#include "runtime/block_errors.h"

#include "codec/order_contractions.h"

#include <utility>

namespace crease {

namespace {

RoundedUp better(RoundedUp a, RoundedUp b) {
  return a.bits < b.bits ? a : b;
}

}  // namespace

BlockErrors::BlockErrors(const BlockHierarchy::Data& data)
    : data_(data),
      of_vertex_(data.leaf_of_vertex.size(), RoundedError::from(data.fine)),
      bounds_(data.hierarchy.vertices.bounds) {
  settle();
}

void BlockErrors::tighten(std::uint32_t vertex, const RoundedError& error) {
  RoundedError& known = of_vertex_[vertex];
  const RoundedError less{better(known.surface, error.surface), better(known.line, error.line),
                          better(known.degrees, error.degrees),
                          better(known.texture, error.texture)};
  if (less == known) return;
  known = less;
  is_new_ = true;
  const bool is_root = vertex < data_.node_of_root.size();
  has_new_root_ |=
      is_root && data_.hierarchy.vertices.split_of(data_.node_of_root[vertex]) == kNoSplit;
}

RoundedError BlockErrors::of_root(std::uint32_t root) const {
  const SplitId s = data_.hierarchy.vertices.split_of(data_.node_of_root[root]);
  if (s == kNoSplit) return of_vertex_[root];
  return error_of(bounds_[index_of(s)]);
}

// Children come after their parents.
BlockErrors::Change BlockErrors::settle() {
  if (!is_new_) return {};
  is_new_ = false;
  const VertexHierarchy& h = data_.hierarchy.vertices;
  // At the fine end of the block that the node's split is of, here.
  std::vector<RoundedError> base(h.node_count()), error(h.node_count());
  for (std::size_t v = 0; v < of_vertex_.size(); ++v) {
    const std::size_t leaf = index_of(data_.leaf_of_vertex[v]);
    base[leaf] = error[leaf] = of_vertex_[v];
  }
  Change change{false, std::exchange(has_new_root_, false)};
  for (std::size_t i = h.split_count(); i-- > 0;) {
    const SplitId s{static_cast<std::uint32_t>(i)};
    const std::size_t node = index_of(h.node_of_split[i]);
    const std::size_t first = index_of(h.first_child(s)), second = index_of(h.second_child(s));
    const bool is_inner = data_.is_inner_split(s);
    const auto base_at = [&](NodeId child) {
      const bool is_at_end = is_inner && !data_.is_inner_split(h.split_of(child));
      return is_at_end ? error[index_of(child)] : base[index_of(child)];
    };
    base[node] = worse(base_at(h.first_child(s)), base_at(h.second_child(s)));
    const LevelError added = codec::added_error(base[node].value(), data_.own_errors[i].value(),
                                                is_inner ? data_.coarser : data_.coarse);
    error[node] = worse(worse(error[first], error[second]), RoundedError::from(added));
    SplitBounds& bounds = bounds_[i];
    const RoundedError before = error_of(bounds);
    if (before == error[node]) continue;
    set_error(bounds, error[node]);
    change.of_splits = true;
    change.of_roots |= h.is_root(NodeId{static_cast<std::uint32_t>(node)});
  }
  return change;
}

std::size_t BlockErrors::bytes() const {
  return sizeof(*this) + sizeof(RoundedError) * of_vertex_.capacity() +
         sizeof(SplitBounds) * bounds_.capacity();
}

}  // namespace crease

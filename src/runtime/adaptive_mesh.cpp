#include "crease/adaptive_mesh.h"

#include "base/assert.h"
#include "runtime/active_cut.h"
#include "runtime/cut_drawing.h"
#include "runtime/extract_cut.h"
#include "runtime/folds.h"
#include "runtime/geomorphs.h"
#include "runtime/refiner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crease {

namespace {

// How many leaves there are under a node, of those that have wedges. A leaf's wedges begin where a
// root's do, or those of some v_u.
class LeafCounts {
 public:
  explicit LeafCounts(const VertexHierarchy& h) {
    std::vector<char> is_begin(h.wedge_count() + 1, 0);
    for (const WedgeId begin : h.root_wedges) is_begin[index_of(begin)] = 1;
    root_count_ = static_cast<float>(std::count(is_begin.begin(), is_begin.end() - 1, 1));
    for (std::size_t s = 0; s < h.split_count(); ++s) is_begin[index_of(h.second_wedge[s])] = 1;
    is_begin.back() = 0;
    for (const char bit : is_begin) begins_.push_back(bit != 0);
  }

  std::uint32_t between(WedgeId begin, WedgeId end) const {
    return begins_.rank(index_of(end)) - begins_.rank(index_of(begin));
  }
  // Of the roots that have wedges. 1 for a model without any.
  float mean_of_roots() const {
    return root_count_ > 0 ? static_cast<float>(begins_.set_count()) / root_count_ : 1.0f;
  }

 private:
  RankedBits begins_;  // per wedge: it is a leaf's first one; and one more
  float root_count_ = 0;
};

}  // namespace

struct AdaptiveMesh::Impl {
  explicit Impl(std::shared_ptr<const MeshHierarchy> given)
      : hierarchy(std::move(given)), cut(*hierarchy), geomorphs(*hierarchy), refiner(&geomorphs) {
    drawing.arrive(cut, geomorphs);
  }

  UpdateReport arrive(UpdateReport report) {
    geomorphs.mark(cut);
    drawing.arrive(cut, geomorphs);
    report.moving = geomorphs.moving_count();
    return report;
  }

  std::shared_ptr<const MeshHierarchy> hierarchy;
  ActiveCut cut;
  Geomorphs geomorphs;
  Refiner refiner;
  CutDrawing drawing;
};

AdaptiveMesh::AdaptiveMesh(std::shared_ptr<const MeshHierarchy> hierarchy)
    : impl_(std::make_unique<Impl>(std::move(hierarchy))) {}
AdaptiveMesh::~AdaptiveMesh() = default;
AdaptiveMesh::AdaptiveMesh(AdaptiveMesh&&) noexcept = default;

UpdateReport AdaptiveMesh::update(const ViewParameters& view, double seconds) {
  impl_->geomorphs.advance(seconds);
  if (!can_see(view.camera)) return impl_->arrive({});
  return impl_->arrive(impl_->refiner.update(impl_->cut, view));
}
UpdateReport AdaptiveMesh::set_error(float error, double seconds) {
  impl_->geomorphs.advance(seconds);
  const float most = std::isnan(error) ? -1 : error;
  return impl_->arrive(impl_->refiner.set_error(impl_->cut, most));
}

std::size_t AdaptiveMesh::unfold(std::size_t max_triangles, std::span<const char> faces_away) {
  std::size_t left = 0, splits = 0;
  do {
    const Folds folds = find_folds(impl_->cut, faces_away);
    left = folds.count;
    splits = impl_->refiner.split_vertices(impl_->cut, folds.slots, max_triangles);
  } while (splits > 0);
  impl_->arrive({});
  return left;
}

void AdaptiveMesh::set_geomorph_seconds(double seconds) {
  impl_->geomorphs.set_seconds(seconds);
}

PartId AdaptiveMesh::part_of(TriangleKind kind, std::size_t triangle) const {
  const auto& parts = hierarchy().vertices.part_of_triangle;
  if (parts.size() == 0) return PartId{0};
  return parts[index_of(impl_->cut.parts()[static_cast<std::size_t>(kind)].ids[triangle])];
}

std::size_t AdaptiveMesh::triangle_count() const {
  return impl_->cut.triangle_count();
}
std::size_t AdaptiveMesh::vertex_count() const {
  return impl_->cut.vertex_count();
}

LevelError AdaptiveMesh::error() const {
  LevelError worst;
  for (const ActiveVertex& v : impl_->cut.vertices()) {
    if (v.node == kNoNode || v.split == kNoSplit) continue;
    const LevelError e = impl_->hierarchy->vertices.bounds[index_of(v.split)].error();
    worst = {std::max(worst.surface, e.surface), std::max(worst.line, e.line),
             std::max(worst.degrees, e.degrees), std::max(worst.texture, e.texture)};
  }
  return worst;
}

DrawList AdaptiveMesh::draw_list() const {
  return impl_->drawing.draw_list(impl_->cut);
}
const DrawChanges& AdaptiveMesh::changes() const {
  return impl_->drawing.changes();
}

std::vector<float> AdaptiveMesh::error_of_position() const {
  std::vector<float> errors;
  errors.reserve(impl_->cut.vertices().size());
  for (const ActiveVertex& v : impl_->cut.vertices()) {
    float error = 0;
    if (v.node != kNoNode && v.split != kNoSplit) {
      const SplitBounds& bounds = impl_->hierarchy->vertices.bounds[index_of(v.split)];
      error = std::max(bounds.surface.value(), bounds.line.value());
    }
    errors.push_back(error);
  }
  return errors;
}

std::vector<float> AdaptiveMesh::level_of_position() const {
  const LeafCounts leaves(impl_->hierarchy->vertices);
  const float coarsest = std::log(leaves.mean_of_roots());
  std::vector<float> levels;
  levels.reserve(impl_->cut.vertices().size());
  for (const ActiveVertex& v : impl_->cut.vertices()) {
    const bool is_coarse = v.node != kNoNode && v.split != kNoSplit && coarsest > 0;
    const auto count = static_cast<float>(is_coarse ? leaves.between(v.begin, v.end) : 1);
    levels.push_back(count > 1 ? std::min(1.0f, std::log(count) / coarsest) : 0.0f);
  }
  return levels;
}

Mesh AdaptiveMesh::extract() const {
  return extract_cut(impl_->cut);
}
const MeshHierarchy& AdaptiveMesh::hierarchy() const {
  return *impl_->hierarchy;
}
std::size_t AdaptiveMesh::active_bytes() const {
  return impl_->cut.bytes() + impl_->drawing.bytes() + impl_->refiner.bytes() +
         impl_->geomorphs.bytes();
}

}  // namespace crease

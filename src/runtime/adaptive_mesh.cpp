#include "crease/adaptive_mesh.h"

#include "base/assert.h"
#include "runtime/active_cut.h"
#include "runtime/cut_drawing.h"
#include "runtime/extract_cut.h"
#include "runtime/geomorphs.h"
#include "runtime/refiner.h"

#include <algorithm>
#include <utility>

namespace crease {

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
  return impl_->arrive(impl_->refiner.update(impl_->cut, view));
}
UpdateReport AdaptiveMesh::set_error(float error, double seconds) {
  impl_->geomorphs.advance(seconds);
  return impl_->arrive(impl_->refiner.set_error(impl_->cut, error));
}

void AdaptiveMesh::set_geomorph_seconds(double seconds) {
  impl_->geomorphs.set_seconds(seconds);
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

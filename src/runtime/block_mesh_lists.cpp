// What a BlockMesh shows and misses, as lists.
#include "base/assert.h"
#include "runtime/block_mesh_impl.h"

#include <algorithm>

namespace crease {

using codec::ModelSchema;

namespace {

DrawList draw_list_of(const LevelList& list, const ModelSchema& schema) {
  const auto part = [](const BlockPart& p) -> DrawPart {
    return {p.indices, p.normals, p.materials, p.colors, p.texcoords};
  };
  DrawList drawn;
  drawn.origin = schema.facts.grid.origin;
  drawn.positions = list.positions;
  drawn.vertex_normals = list.vertex_normals;
  drawn.sn = part(list.sn);
  drawn.fn = part(list.fn);
  drawn.nsn = part(list.nsn);
  drawn.materials = schema.materials;
  return drawn;
}

}  // namespace

// Mostly the lists are those of before, and in their places.
void BlockMesh::Impl::list_cuts() {
  std::size_t count = 0;
  cut_triangles = 0;
  const auto add = [&](std::uint32_t block, std::uint64_t revision, const auto& draw_list) {
    if (count == listed.size()) {
      listed.emplace_back();
      shown_cuts.emplace_back();
    }
    ListedCut& at = listed[count];
    const ResidentBlock* const its = resident[block].get();
    if (at.revision != revision || at.block != its || was_by_vertex) {
      shown_cuts[count] = draw_list(its);
      at = {its, revision, shown_cuts[count].triangle_count()};
    }
    cut_triangles += at.triangles;
    count += at.triangles > 0;
  };
  for (const std::uint32_t block : cut) {
    if (const LevelList* const list = levels.list(block)) {
      add(block, levels.revision(block), [&](const ResidentBlock* its) -> ShownCut {
        return {its, draw_list_of(*list, *schema), list->revision, list->groups};
      });
      continue;
    }
    const BlockCut* const by_vertex = cuts.cut(block);
    if (by_vertex == nullptr || by_vertex->live() == nullptr) continue;
    add(block, by_vertex->revision(), [&](const ResidentBlock* its) -> ShownCut {
      return {its, by_vertex->draw_list(), by_vertex->revision()};
    });
  }
  listed.resize(count);
  shown_cuts.resize(count);
}

PartId BlockMesh::part_of(const ShownCut& shown, TriangleKind kind, std::size_t triangle) const {
  const auto block = static_cast<std::uint32_t>(index_of(shown.block->id()));
  if (const LevelList* const list = impl_->levels.list(block)) {
    const BlockPart& part = kind == TriangleKind::SN   ? list->sn
                            : kind == TriangleKind::FN ? list->fn
                                                       : list->nsn;
    return part_in(part, triangle);
  }
  const BlockCut* const cut = impl_->cuts.cut(block);
  CREASE_ASSERT(cut != nullptr);
  const ResidentBlock::Data& data = shown.block->data();
  const std::uint32_t of_block =
      cut->triangle_of(static_cast<Part>(kind), static_cast<std::uint32_t>(triangle));
  return PartId{data.end.category(of_block) / data.schema->coding.material_count};
}

std::vector<ErrorSphere> BlockMesh::errors_of(const ResidentBlock& block,
                                              const BlockGroup& group) const {
  const std::uint32_t finer = impl_->graph.next_finer(block.facts().band, group.patch);
  if (finer == kNone) return {};
  return impl_->levels.errors(finer, 0);
}

std::vector<float> BlockMesh::error_of_position(const ShownCut& cut) const {
  const auto block = static_cast<std::uint32_t>(index_of(cut.block->id()));
  if (cut.groups.empty()) return impl_->cuts.error_of_position(block);
  const std::vector<ErrorSphere> spheres =
      impl_->levels.errors(block, impl_->levels.list(block)->level);
  std::vector<float> errors(cut.list.positions.size(), 0);
  for (const ErrorSphere& sphere : spheres) {
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (length(cut.list.positions[i] - sphere.center) > sphere.radius) continue;
      errors[i] = std::max(errors[i], sphere.error);
    }
  }
  return errors;
}

void BlockMesh::Impl::list_missing_hierarchies() {
  missing_hierarchies.clear();
  if (!was_by_vertex) return;
  for (const std::uint32_t block : could_be) {
    if (!cuts.hierarchy(block)) missing_hierarchies.push_back(graph.entry(block).id);
  }
}

void BlockMesh::Impl::list_shown() {
  shown.clear();
  shown_triangles = 0;
  for (const std::uint32_t block : cut) {
    if (cuts.cut(block) == nullptr && levels.shown(block) == kFullLevel) list_shown_of(block);
  }
  for (const ShownRange& range : shown) shown_triangles += range.triangle_count();
}

void BlockMesh::Impl::list_shown_of(std::uint32_t block) {
  bool goes_on = false;
  for (const PatchRun& run : runs[block]) {
    const bool shows = run.finer == kNone || levels.shown(run.finer) == 0;
    if (shows && goes_on) {
      ShownRange& range = shown.back();
      range.sn.count += run.range.sn.count;
      range.fn.count += run.range.fn.count;
      range.nsn.count += run.range.nsn.count;
    } else if (shows) {
      shown.push_back(run.range);
    }
    goes_on = shows;
  }
}

std::vector<PatchRun> BlockMesh::Impl::runs_of(const ResidentBlock& block) const {
  std::vector<PatchRun> result;
  const BlockGroup* before = nullptr;
  for (const BlockGroup& group : block.groups()) {
    if (before == nullptr || before->patch != group.patch) {
      result.push_back({graph.next_finer(block.facts().band, group.patch),
                        {&block, group.sn, group.fn, group.nsn}});
    } else {
      ShownRange& range = result.back().range;
      range.sn.count += group.sn.count;
      range.fn.count += group.fn.count;
      range.nsn.count += group.nsn.count;
    }
    before = &group;
  }
  result.shrink_to_fit();
  return result;
}

}  // namespace crease

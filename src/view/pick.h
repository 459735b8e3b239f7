// What a ray meets first.
#pragma once

#include "crease/block_mesh.h"
#include "crease/draw_list.h"
#include "crease/mesh.h"
#include "crease/shading.h"
#include "render/draw_ranges.h"
#include "view/camera_moves.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace crease {

struct Hit {
  double along = 0;  // of the ray, in lengths of its direction
  Vec3d position;
  std::array<Vec3d, 3> corners;
  TriangleKind kind{};
  std::uint32_t triangle = 0;  // in its part
  Vec3f normal;                // that is shown there: of the triangle, or between its corners'
  std::string material;        // its name, or empty
  const ResidentBlock* block = nullptr;
  bool is_by_vertex = false;  // the triangle is of a cut through the block, not one of its own
};

// What the way in which a model is shown knows of it beside.
struct HitFacts {
  std::string level;  // in words
  LevelError error;   // of what is shown there
  std::string part;   // its name, or empty
};

// Of all triangles of a list. Time O(triangles).
std::optional<Hit> pick(const DrawList& list, const Ray& ray);
std::optional<Hit> pick(const DrawList& list, const DrawRanges& ranges, const Ray& ray);

// Of blocks, those that the ray passes by are not looked into.
std::optional<Hit> pick(std::span<const ShownRange> shown, const Grid& grid, const Ray& ray);
std::optional<Hit> pick(std::span<const ShownCut> shown, const Grid& grid, const Ray& ray);

// The name of the part that a triangle of a block belongs to, or empty. `mesh` shows it.
std::string part_of(const Hit& hit, const BlockMesh& mesh);
std::string name_of(PartId part, std::span<const std::string> names);

const DrawPart& part_of_kind(const DrawList& list, TriangleKind kind);

}  // namespace crease

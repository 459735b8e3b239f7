// The active triangles of one of the three parts of a draw list (SN, FN, NSN), in no order.
//
// A triangle that is taken away leaves a hole, which the next new one fills; holes that are left
// when all moves are done are filled from the end (CutDrawing). So a frame that splits as much as
// it merges moves no triangle in memory and uploads nothing but what changed.
//
// Memory per triangle: slots 12, id 4, a flag 1, 12 per attribute layer that ever has two
// attributes at a vertex; for drawing FN normal 12, NSN normals 36, colours 48, texture coordinates
// 24, material 4; 3 bits of marks.
#pragma once

#include "crease/mesh_hierarchy.h"
#include "runtime/change_set.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

enum Part : std::uint32_t { kSnPart, kFnPart, kNsnPart, kPartCount };

inline constexpr TriangleId kNoTriangle{kNone};

struct ActiveTriangles {
  std::vector<TriangleId> ids;       // kNoTriangle: a hole
  std::vector<std::uint32_t> slots;  // 3 a triangle: the active vertices
  // Per corner one for each tracked layer: its value, where its vertex has several.
  std::vector<std::uint32_t> values;
  std::vector<std::uint8_t> is_derived;  // it shows its geometric normal, if it has one
  std::vector<std::uint32_t> holes;      // may name triangles beyond the end
  std::size_t hole_count = 0;            // in front of the end
  ChangeSet moved;                       // slots changed
  ChangeSet touched;                     // kind, normals, colours may have changed
  ChangeSet shaded;                      // normals, colours or texture coordinates did

  // What is drawn beside the slots; CutDrawing keeps it.
  std::vector<Vec3f> normals;                   // FN: 1 a triangle, NSN: 3
  std::vector<std::array<float, 4>> colors;     // 3 a triangle, or empty
  std::vector<std::array<float, 2>> texcoords;  // the same
  std::vector<std::uint32_t> materials;         // or empty

  std::size_t size() const { return ids.size(); }
  std::size_t count() const { return ids.size() - hole_count; }

  static constexpr std::size_t kMoreAtOnce = 255;

  // A place for a triangle, in a hole or at the end.
  std::uint32_t add(TriangleId id, std::size_t values_per_triangle) {
    while (hole_count > 0) {
      const std::uint32_t hole = holes.back();
      holes.pop_back();
      prefetch_hole();
      if (hole >= ids.size() || ids[hole] != kNoTriangle) continue;
      --hole_count;
      ids[hole] = id;
      return hole;
    }
    holes.clear();
    ids.push_back(id);
    if (slots.size() < 3 * ids.size()) grow(values_per_triangle);
    return static_cast<std::uint32_t>(ids.size() - 1);
  }

  // Too large until the holes are filled.
  [[gnu::noinline]] void grow(std::size_t values_per_triangle) {
    const std::size_t size = ids.size() + kMoreAtOnce;
    slots.resize(3 * size);
    values.resize(values_per_triangle * size);
    is_derived.resize(size);
    for (ChangeSet* set : {&moved, &touched, &shaded}) set->grow(size);
  }

  // Of those that the next ones fill.
  void prefetch_hole() const {
    constexpr std::size_t kAhead = 8;
    if (holes.size() < kAhead) return;
    const std::uint32_t hole = holes[holes.size() - kAhead];
    __builtin_prefetch(ids.data() + hole);
    __builtin_prefetch(slots.data() + 3 * std::size_t(hole));
  }

  void remove(std::uint32_t triangle) {
    ids[triangle] = kNoTriangle;
    holes.push_back(triangle);
    ++hole_count;
  }
};

}  // namespace crease

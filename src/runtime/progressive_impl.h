// The state of hierarchy/linear_state.h, with the float buffers of three draw calls beside it.
// While the level moves, elements are only marked; when it has arrived, those that are active are
// computed from the state. So a switch costs O(corners that change) however long it is.
//
// Geomorphs: a finer level is taken at once, and its vertices start where those were seen that they
// come out of. A coarser one is looked up, to know where everything will be (there and back again
// restores all bits); everything goes there; then the level is taken, and nothing moves. What is
// asked for meanwhile waits, unless it is finer: then everything turns back. So contractions that
// go together arrive together.
//
// Memory beside the shared arrays: a vertex 24, an SN vertex 12, a triangle 12, an FN triangle 13,
// an NSN triangle 49; where there are geomorphs an SN vertex 12 more; 48 a triangle where there are
// colours, 24 where there are textures; change sets of a bit an element.
#pragma once

#include "crease/progressive_mesh.h"
#include "hierarchy/linear_state.h"
#include "runtime/change_set.h"
#include "runtime/draw_values.h"
#include "runtime/interpolate.h"
#include "runtime/ways.h"

#include <array>
#include <vector>

namespace crease {

enum Section { kSn, kFn, kNsn, kSectionCount };

struct ProgressiveMesh::Impl {
  explicit Impl(ProgressiveArraysPtr given);

  struct TrianglePart {
    std::uint32_t first = 0;                      // its first triangle
    std::vector<Vec3f> normals;                   // FN: 1 a triangle, NSN: 3
    std::vector<std::array<float, 4>> colors;     // 3 a triangle, or empty
    std::vector<std::array<float, 2>> texcoords;  // the same
    ChangeSet index_changes, normal_changes;
    ChangeSet color_changes;  // of both
    std::uint32_t normals_per_triangle = 0;
    std::size_t drawn = 0;  // triangles that were active when it last arrived
    Ways ways{slerp};       // of `normals`

    bool is_painted() const { return !colors.empty() || !texcoords.empty(); }
  };

  // What LinearState calls while the level moves.
  struct Marks {
    Impl& mesh;
    void position(std::uint32_t slot) { mesh.position_changes.mark(slot); }
    void own_normal(std::uint32_t slot) { mesh.own_normal_changes.mark(slot); }
    void corner(std::uint32_t c) {
      const std::uint32_t t = c / 3;
      TrianglePart& part = mesh.part_of(t);
      part.index_changes.mark(t - part.first);
      touched(c);
    }
    void index(std::uint32_t layer, std::uint32_t c) {
      TrianglePart& part = mesh.part_of(c / 3);
      if (layer == 0) part.normal_changes.mark(c / 3 - part.first);
      if (layer == mesh.color_layer + 1 || layer == mesh.texcoord_layer + 1) {
        part.color_changes.mark(c / 3 - part.first);
      }
    }
    void derived(std::uint32_t t) {
      TrianglePart& part = mesh.part_of(t);
      part.normal_changes.mark(t - part.first);
    }
    void touched(std::uint32_t c) {
      const std::uint32_t t = c / 3;
      TrianglePart& part = mesh.part_of(t);
      if (mesh.state.is_derived(t)) part.normal_changes.mark(t - part.first);
      if (part.is_painted()) part.color_changes.mark(t - part.first);
    }
  };

  TrianglePart& part_of(std::uint32_t t) {
    return parts[t < parts[kFn].first ? kSn : t < parts[kNsn].first ? kFn : kNsn];
  }
  std::uint32_t active_of(int section) const {
    const SectionCounts& active = state.active();
    return section == kSn   ? active.sn_triangles
           : section == kFn ? active.fn_triangles
                            : active.nsn_triangles;
  }
  Vec3f shown_normal(std::uint32_t c) const;
  void refresh_normals(TrianglePart& part, std::size_t t);
  void refresh_colors(TrianglePart& part, std::size_t t);
  void arrive();
  void move_to(std::size_t count);

  // Geomorphs, in progressive_geomorphs.cpp.
  struct Looked;
  void want(std::size_t count);
  void advance(double passed);
  bool is_moving() const;
  void go_finer(std::size_t count);
  void go_coarser();
  void look_at(std::size_t count, Looked& looked);
  void turn_back();
  void take_coarser();
  void mark_moving();
  void forget_arrived();
  Vec3f own_position(std::uint32_t slot) const {
    return draw_position(arrays->grid, state.positions[slot]);
  }
  Vec3f shown_position(std::uint32_t slot) const {
    const Way* const way = position_ways.find(slot);
    return way == nullptr ? own_position(slot) : position_ways.shown(*way, now, seconds);
  }
  Vec3f shown_own_normal(std::uint32_t slot) const {
    const Way* const way = own_normal_ways.find(slot);
    return way == nullptr ? state.own_normals[slot] : own_normal_ways.shown(*way, now, seconds);
  }
  bool is_coarsening() const { return taken_at > state.applied(); }
  DrawPart draw_part(int section) const;

  ProgressiveArraysPtr arrays;
  LinearState state;
  std::vector<Vec3f> positions;
  std::array<TrianglePart, kSectionCount> parts;
  std::uint32_t color_layer = kMaxLayers;     // of arrays->layers; kMaxLayers: none
  std::uint32_t texcoord_layer = kMaxLayers;  // the same
  ChangeSet position_changes, own_normal_changes;
  DrawChanges changes;
  std::size_t base_triangles = 0;

  double seconds = 0, now = 0;     // of geomorphs
  std::vector<Vec3f> own_normals;  // as they are seen; empty before there are geomorphs
  Ways position_ways{lerp}, own_normal_ways{slerp};
  std::size_t wanted = 0;    // contractions in force at last
  std::size_t taken_at = 0;  // that what is leaving leads to; else as applied
  double began_leaving = 0;
  std::size_t wanted_triangles = 0;
};

}  // namespace crease

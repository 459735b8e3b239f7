// Normals that a pass made, fitted to those of the input.
//
// A contraction gives its vertex what is best for this vertex by itself: the mean of what the
// triangles around say of its place. But between vertices normals are interpolated, so the best
// ones depend on each other. Those that a pass made become the least squares, all over the surface,
// of the differences between the normals shown and the input's; those of vertices that it left
// alone stay. Levels' normals come some percent nearer to the input's, and so does what the next
// pass measures by them.
#pragma once

#include "crease/mesh.h"
#include "simplify/work_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::simplification {

class NormalFit {
 public:
  // `input` is what `work` was made from; both outlive it. Without normals it does nothing.
  NormalFit(const Mesh& input, const Grid& grid, WorkMesh& work);

  void note_contraction(std::uint32_t removed, std::uint32_t kept) {
    if (layer_) now_at_[removed] = kept;
  }
  std::size_t value_count() const { return layer_ ? layer_->value_count() : 0; }

  // Of the values from this one on, each of which stands at one vertex; once all that the pass
  // contracted was noted. Linear in the triangles that are left and in the candidates of the pass
  // before; nothing while more than a sixth of the input's triangles are left. Uses all threads,
  // and gives the same for any number of them.
  void fit(std::size_t first_value);

 private:
  // A point of the input, and where it is in the surface that is left.
  struct Sample {
    Vec3f point;  // grid units
    Vec3f normal;
    float area = 0;
    std::uint32_t vertex = kNone;    // near it
    std::uint32_t triangle = kNone;  // the nearest around the vertices that were looked at
    float squared = 0;               // how far away it is
    float second = 0, third = 0;     // shares of its corners
    bool goes_on = true;             // another vertex is to be looked at
  };
  // Of a triangle, by corner: what multiplies its value, that of the other two at each other, and
  // what they should come to.
  struct Equations {
    float own[3] = {}, across[3] = {};
    Vec3f sum[3] = {};
  };
  struct Fan;

  void find_corners();
  std::span<const std::uint32_t> corners_of(std::uint32_t vertex) const;
  bool is_live(std::uint32_t vertex) const {
    const std::uint32_t place = place_of_vertex_[vertex];
    return place < vertices_.size() && vertices_[place] == vertex;
  }
  Vec3d position(std::uint32_t vertex) const {
    const Vec3i& p = work_.positions[vertex];
    return {double(p.x), double(p.y), double(p.z)};
  }
  // As WorkLayer::value(), which divides.
  const float* value_of(std::size_t id) const {
    return id < input_values_ ? &layer_->source->values[3 * id]
                              : &layer_->new_values[3 * (id - input_values_)];
  }
  const float* value_at(std::size_t corner) const { return value_of(layer_->of_corner[corner]); }
  std::size_t choose_samples(std::size_t from, double share, double part);
  Sample sample_of(std::uint32_t triangle, std::uint32_t place, double area) const;
  void find_triangles();
  void sort_by_vertex(std::vector<std::uint32_t>& samples);
  void load_fan(std::uint32_t vertex, Fan& fan) const;
  void look_around(const Fan& fan, Sample& sample) const;
  void add(const Sample& sample);
  void solve(std::size_t first_value);
  Vec3d better_value(std::uint32_t vertex, std::uint32_t id, const float* start) const;

  const Mesh& input_;
  const Vec3d origin_;
  const double per_step_;
  WorkMesh& work_;
  WorkLayer* layer_ = nullptr;
  std::size_t input_values_ = 0;
  std::vector<float> input_area_;          // by triangle, grid units
  double area_ = 0;                        // of all
  std::vector<std::uint32_t> candidates_;  // input triangles that samples may come from, ascending
  std::vector<std::uint32_t> now_at_;      // per input vertex: what it has become
  std::vector<std::uint32_t> vertices_;    // that live triangles have
  std::vector<std::uint32_t> place_of_vertex_;         // in vertices_, of those
  std::vector<std::uint32_t> first_corner_, corners_;  // of live triangles, by place of vertex
  std::vector<Sample> samples_;                        // some of them at a time
  std::vector<std::uint32_t> first_sample_;            // by place of vertex
  std::vector<std::uint32_t> place_of_triangle_;       // in work.live
  std::vector<Equations> equations_;                   // by place in work.live
};

}  // namespace crease::simplification

// How far what two meshes carry besides normals differs where the one is nearest to the other.
//
//   const SharedAttributes shared(a, b);
//   shared.deviation(attribute, sample_of_a, candidates_on_b, 0);   // 1: from b to a
#pragma once

#include "crease/compare.h"
#include "measure/sample.h"
#include "measure/surface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

class SharedAttributes {
 public:
  // Keeps references to both.
  SharedAttributes(const Mesh& a, const Mesh& b);

  std::size_t count() const { return shared_.size(); }
  const std::string& name(std::size_t attribute) const { return shared_[attribute].name; }
  DeviationUnit unit(std::size_t attribute) const { return shared_[attribute].unit; }
  // The least among the candidates, which lie within the tie, from what the sample carries.
  // `from`: 0 where the sample is of a, 1 where it is of b.
  double deviation(std::size_t attribute, const SurfacePoint& sample,
                   std::span<const Surface::Scratch::Candidate> candidates, std::size_t from) const;

 private:
  using Weights = std::array<double, 3>;
  struct Shared {
    std::string name;
    DeviationUnit unit = DeviationUnit::Values;
    std::array<const AttributeLayer*, 2> layers{};  // of a, of b; null: labels of triangles
    std::array<std::vector<std::uint32_t>, 2> label_of_triangle{};  // equal names, equal labels
  };

  void share_layers(const Mesh& a, const Mesh& b);
  static double deviation(const Shared& shared, std::size_t from, std::size_t triangle,
                          const Weights& weights, std::size_t other, const Weights& other_weights);

  std::vector<Shared> shared_;
};

}  // namespace crease

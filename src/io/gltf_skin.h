// Skins (3.7.3.3): joints move the vertices of a mesh, instead of the node that shows it.
//
//   GltfSkins skins(json, reader);
//   const std::vector<Transform>& joints = skins.joints_of(*instance.skin, *scene);
//   Result<JointWeights> weights = read_joint_weights(source, reader, attributes, place, count);
//   if (weights.ok() && check_joints(...).ok()) Placement({}, joints, *weights).of(v).point(p);
#pragma once

#include "crease/result.h"
#include "io/gltf_document.h"
#include "io/gltf_scene.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace crease {

// Which joints move the vertices of a primitive: of all its sets JOINTS_n and WEIGHTS_n.
struct JointWeights {
  struct Entry {
    std::uint32_t vertex = 0, joint = 0;
    float weight = 0;  // any but zero; the sum of a vertex's need not be one
  };
  std::vector<Entry> entries;          // by vertex, of one by joint
  std::vector<std::size_t> of_vertex;  // where its entries begin, and the last one's end; or empty

  bool empty() const { return of_vertex.empty(); }  // the primitive has no set
};
Result<JointWeights> read_joint_weights(const Source& source, GltfReader& reader,
                                        const Json& attributes, const std::string& place,
                                        std::size_t vertex_count);

// Fails if one of them is not of `joint_count`.
Status check_joints(const Source& source, const JointWeights& weights, std::size_t joint_count,
                    const std::string& place);

// What each joint of a skin makes of a vertex in the pose that the file's nodes have: where the
// joint is after where the mesh was bound to it. A joint that is broken moves nothing.
class GltfSkins {
 public:
  GltfSkins(const Json& json, GltfReader& reader) : json_(json), reader_(reader) {}

  // Never empty. Stays as long as this.
  const std::vector<Transform>& joints_of(std::size_t skin, const GltfScene& scene);

  std::size_t broken_joints() const { return broken_joints_; }

 private:
  std::vector<Transform> read(const Json& skin, const GltfScene& scene);

  const Json& json_;
  GltfReader& reader_;
  std::map<std::size_t, std::vector<Transform>> joints_of_skin_;
  std::size_t broken_joints_ = 0;
};

// How an instance of a primitive moves its vertices: all alike, or each as its joints do.
class Placement {
 public:
  explicit Placement(const Transform& to_world) : to_world_(to_world) {}
  // `inner` first, then the joints, which stay. Where there are no weights the first moves all.
  Placement(const Transform& inner, const std::vector<Transform>& joints,
            const JointWeights& weights)
      : to_world_(weights.empty() ? joints.front().after(inner) : inner),
        joints_(weights.empty() ? nullptr : &joints),
        weights_(&weights) {}

  bool has_joints() const { return joints_ != nullptr; }
  Transform of(std::size_t vertex) const;

 private:
  Transform to_world_;
  const std::vector<Transform>* joints_ = nullptr;
  const JointWeights* weights_ = nullptr;
};

}  // namespace crease

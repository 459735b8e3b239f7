#include "io/gltf_skin.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace crease {

namespace {

// More than any file has: sets may share accessors, so that each would cost but its name.
constexpr std::size_t kMaxSets = 8;

std::string in_set(const char* semantic, std::size_t set) {
  return semantic + std::to_string(set);
}

Status add_set(const Source& source, GltfReader& reader, const Json& attributes,
               const std::string& place, std::size_t set, std::size_t vertex_count,
               std::vector<JointWeights::Entry>& entries) {
  const std::string joints_name = in_set("JOINTS_", set), weights_name = in_set("WEIGHTS_", set);
  const std::string joints_place = place + "." + joints_name;
  const std::string weights_place = place + "." + weights_name;
  const auto joints = reader.floats(at(attributes, joints_name.c_str()), 4, 4, joints_place);
  if (!joints.ok()) return joints.failure();
  const auto weights = reader.floats(at(attributes, weights_name.c_str()), 4, 4, weights_place);
  if (!weights.ok()) return weights.failure();
  if (joints->count() != vertex_count || weights->count() != vertex_count) {
    return fail_at_place(Error::BadValue, source,
                         joints->count() != vertex_count ? joints_place : weights_place,
                         "not a value for every vertex");
  }
  for (std::size_t i = 0; i < weights->values.size(); ++i) {
    const float weight = weights->values[i], joint = joints->values[i];
    if (weight == 0) continue;
    if (!std::isfinite(weight)) {
      return fail_at_place(Error::BadValue, source, place_of(weights_place, i / 4), "not finite");
    }
    if (!(joint >= 0 && joint <= 65535)) {
      return fail_at_place(Error::BadValue, source, place_of(joints_place, i / 4), "no joint");
    }
    entries.push_back(
        {static_cast<std::uint32_t>(i / 4), static_cast<std::uint32_t>(joint), weight});
  }
  return Done{};
}

}  // namespace

Result<JointWeights> read_joint_weights(const Source& source, GltfReader& reader,
                                        const Json& attributes, const std::string& place,
                                        std::size_t vertex_count) {
  const auto has = [&](const char* semantic, std::size_t set) {
    return !at(attributes, in_set(semantic, set).c_str()).is_null();
  };
  JointWeights weights;
  std::size_t set = 0;
  for (; has("JOINTS_", set) && has("WEIGHTS_", set); ++set) {
    if (set >= kMaxSets) {
      return fail_at_place(Error::OverLimit, source, place,
                           "more than " + std::to_string(4 * kMaxSets) + " joints a vertex");
    }
    Status added = add_set(source, reader, attributes, place, set, vertex_count, weights.entries);
    if (!added.ok()) return added.failure();
  }
  if (set == 0) return weights;
  // By joint, so that vertices at one place whose joints are named in another order stay at one.
  std::sort(weights.entries.begin(), weights.entries.end(),
            [](const JointWeights::Entry& a, const JointWeights::Entry& b) {
              return std::tie(a.vertex, a.joint, a.weight) < std::tie(b.vertex, b.joint, b.weight);
            });
  weights.of_vertex.assign(vertex_count + 1, 0);
  for (const JointWeights::Entry& entry : weights.entries) ++weights.of_vertex[entry.vertex + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) weights.of_vertex[v + 1] += weights.of_vertex[v];
  return weights;
}

Status check_joints(const Source& source, const JointWeights& weights, std::size_t joint_count,
                    const std::string& place) {
  for (const JointWeights::Entry& entry : weights.entries) {
    if (entry.joint < joint_count) continue;
    return fail_at_place(Error::BadValue, source, place,
                         "vertex " + std::to_string(entry.vertex) + " hangs on joint " +
                             std::to_string(entry.joint) + ", and the skin has " +
                             std::to_string(joint_count));
  }
  return Done{};
}

const std::vector<Transform>& GltfSkins::joints_of(std::size_t skin, const GltfScene& scene) {
  const auto [known, is_new] = joints_of_skin_.try_emplace(skin);
  if (is_new) known->second = read(at(at(json_, "skins"), skin), scene);
  return known->second;
}

std::vector<Transform> GltfSkins::read(const Json& skin, const GltfScene& scene) {
  const Json& joints = at(skin, "joints");
  const Json& stored = at(skin, "inverseBindMatrices");
  GltfReader::Floats to_joint;
  if (!stored.is_null()) {
    auto read = reader_.floats(stored, 16, 16, "inverseBindMatrices");
    if (read.ok()) to_joint = *std::move(read);
  }
  std::vector<Transform> result(std::max<std::size_t>(size_of(joints), 1));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto node = as_index(at(joints, i));
    const bool is_node =
        node && *node < scene.to_world_of_node.size() && scene.to_world_of_node[*node].has_value();
    if (!is_node || (!stored.is_null() && i >= to_joint.count())) {
      ++broken_joints_;
      continue;
    }
    result[i] = *scene.to_world_of_node[*node];
    if (!stored.is_null()) {
      result[i] = result[i].after(transform_of(&to_joint.values[16 * i]));
    }
  }
  return result;
}

Transform Placement::of(std::size_t vertex) const {
  if (!has_joints()) return to_world_;
  const std::size_t begin = weights_->of_vertex[vertex], end = weights_->of_vertex[vertex + 1];
  if (begin == end) return joints_->front().after(to_world_);
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(weights_->entries[i].weight);
  Transform blend{{}, {}, {}, {}};
  for (std::size_t i = begin; i < end; ++i) {
    const Transform& joint = (*joints_)[weights_->entries[i].joint];
    const double share = static_cast<double>(weights_->entries[i].weight) / sum;
    blend.x += joint.x * share;
    blend.y += joint.y * share;
    blend.z += joint.z * share;
    blend.origin += joint.origin * share;
  }
  return blend.after(to_world_);
}

}  // namespace crease

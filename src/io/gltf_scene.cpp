#include "io/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace crease {
namespace {

// The 3 * 3 part by columns, of a unit quaternion (x, y, z, w).
Transform rotation(double x, double y, double z, double w) {
  const double norm = std::sqrt(x * x + y * y + z * z + w * w);
  Transform r;
  if (!(norm > 0)) return r;
  x /= norm, y /= norm, z /= norm, w /= norm;
  r.x = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  r.y = {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  r.z = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
  return r;
}

// 3.5.3: `matrix` (column-major), or translation * rotation * scale.
Result<Transform> local_transform(const Source& source, const Json& node,
                                  const std::string& place) {
  const auto bad = [&](const char* member) {
    return fail_at_place(Error::BadFormat, source, place + "." + member, "not a transform");
  };
  const auto numbers = [&](const char* member, std::size_t count, double* to) {
    const Json& array = at(node, member);
    if (array.is_null()) return true;  // keeps the default
    if (size_of(array) != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (!array[i].is_number()) return false;
      to[i] = array[i].get<double>();
    }
    return true;
  };
  if (!at(node, "matrix").is_null()) {
    double m[16];
    if (!numbers("matrix", 16, m)) return bad("matrix");
    return transform_of(m);
  }
  double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  if (!numbers("translation", 3, t)) return bad("translation");
  if (!numbers("rotation", 4, q)) return bad("rotation");
  if (!numbers("scale", 3, s)) return bad("scale");
  return transform_of_trs(t, q, s);
}

// The last node that has it for a child, of each node.
std::vector<std::optional<std::size_t>> parents_of(const Json& nodes) {
  std::vector<std::optional<std::size_t>> parents(size_of(nodes));
  for (std::size_t i = 0; i < parents.size(); ++i) {
    const Json& children = at(nodes[i], "children");
    for (std::size_t c = 0; c < size_of(children); ++c) {
      const auto child = as_index(children[c]);
      if (child && *child < parents.size()) parents[*child] = i;
    }
  }
  return parents;
}

// Joints may stand beside the scene. What is broken there, or in a loop, stands nowhere.
void place_others(const Source& source, const Json& nodes,
                  std::vector<std::optional<Transform>>& to_world_of_node) {
  const std::vector<std::optional<std::size_t>> parents = parents_of(nodes);
  std::vector<bool> is_tried(parents.size(), false);
  std::vector<std::size_t> upwards;  // from a node to below one that is settled
  for (std::size_t i = 0; i < parents.size(); ++i) {
    upwards.clear();
    std::optional<std::size_t> above = i;
    for (; above && !is_tried[*above] && !to_world_of_node[*above]; above = parents[*above]) {
      is_tried[*above] = true;
      upwards.push_back(*above);
    }
    std::optional<Transform> parent = above ? to_world_of_node[*above] : Transform{};
    for (; parent && !upwards.empty(); upwards.pop_back()) {
      const std::size_t node = upwards.back();
      const Result<Transform> local = local_transform(source, nodes[node], place_of("nodes", node));
      if (!local.ok()) break;
      parent = parent->after(*local);
      to_world_of_node[node] = parent;
    }
  }
}

struct Roots {
  std::vector<Json> nodes;  // to begin with
  std::string place;        // that names them
};

Result<Roots> root_nodes(const Source& source, const Json& json) {
  const Json& scenes = at(json, "scenes");
  if (size_of(scenes) > 0) {
    const Json& chosen = at(json, "scene");
    const std::size_t scene = chosen.is_null() ? 0 : as_index(chosen).value_or(size_of(scenes));
    if (scene >= size_of(scenes)) {
      return fail_at_place(Error::BadValue, source, "scene",
                           "no such scene: the file has " + std::to_string(size_of(scenes)));
    }
    const Json& nodes = at(scenes[scene], "nodes");
    Roots roots{{}, place_of("scenes", scene) + ".nodes"};
    for (std::size_t i = 0; i < size_of(nodes); ++i) roots.nodes.push_back(nodes[i]);
    return roots;
  }
  const Json& nodes = at(json, "nodes");
  const std::vector<std::optional<std::size_t>> parents = parents_of(nodes);
  Roots roots{{}, "nodes"};
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (!parents[i]) roots.nodes.push_back(i);
  }
  return roots;
}

// Meshes that are not in the scene, of which `reached` are the nodes.
void tell_left_out(const Json& json, const std::vector<bool>& reached,
                   std::vector<std::string>& notes) {
  const Json& nodes = at(json, "nodes");
  std::vector<bool> has_node(size_of(at(json, "meshes")), false);
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto mesh = as_index(at(nodes[i], "mesh"));
    if (!mesh || *mesh >= has_node.size()) continue;
    has_node[*mesh] = true;
    if (!reached[i]) ++left_out;
  }
  if (left_out > 0) {
    notes.push_back(std::to_string(left_out) + " nodes with meshes left out: not in the scene");
  }
  const auto unused = std::count(has_node.begin(), has_node.end(), false);
  if (unused > 0) notes.push_back(std::to_string(unused) + " meshes left out: no node has them");
}

std::vector<double> weights_of(const Json& mesh, const Json& node) {
  const Json& stored = at(at(node, "weights").is_null() ? mesh : node, "weights");
  std::vector<double> weights;
  for (std::size_t k = 0; k < size_of(stored); ++k) weights.push_back(as_number(stored[k], 0));
  return weights;
}

bool has_name(const Json& named) {
  return !as_text(at(named, "name")).empty();
}

std::string name_of(const Json& named, const std::string& otherwise) {
  std::string name = as_text(at(named, "name"));
  return name.empty() ? otherwise : name;
}

}  // namespace

Transform Transform::after(const Transform& inner) const {
  return {direction(inner.x), direction(inner.y), direction(inner.z), point(inner.origin)};
}

double Transform::determinant() const {
  return dot(x, cross(y, z));
}

Transform Transform::of_normals() const {
  const double sign = determinant() < 0 ? -1.0 : 1.0;
  return {cross(y, z) * sign, cross(z, x) * sign, cross(x, y) * sign, {}};
}

bool Transform::only_scales() const {
  return x.x > 0 && x.x == y.y && y.y == z.z && x.y == 0 && x.z == 0 && y.x == 0 && y.z == 0 &&
         z.x == 0 && z.y == 0;
}

Transform transform_of_trs(const double* translation, const double* q, const double* scale) {
  Transform result = rotation(q[0], q[1], q[2], q[3]);
  result.x = result.x * scale[0];
  result.y = result.y * scale[1];
  result.z = result.z * scale[2];
  result.origin = {translation[0], translation[1], translation[2]};
  return result;
}

Result<GltfScene> walk_scene(const Source& source, const Json& json) {
  GltfScene scene;
  const Json& nodes = at(json, "nodes");
  const Json& meshes = at(json, "meshes");
  if (size_of(nodes) == 0) {
    for (std::size_t i = 0; i < size_of(meshes); ++i) {
      scene.instances.push_back({i,
                                 {},
                                 name_of(meshes[i], "mesh " + std::to_string(i)),
                                 weights_of(meshes[i], meshes[i]),
                                 {},
                                 has_name(meshes[i])});
    }
    return scene;
  }

  struct Pending {
    std::size_t node = 0;
    Transform parent;
    bool is_hidden = false;
  };
  std::vector<Pending> pending;  // a stack, so that deep graphs need no deep recursion
  std::vector<bool> reached(size_of(nodes), false);
  scene.to_world_of_node.resize(size_of(nodes));
  // Pushes node references in reverse, so that they come off in order.
  const auto push_all = [&](const auto& references, std::size_t count, const std::string& place,
                            const Transform& parent, bool is_hidden) -> Status {
    for (std::size_t i = count; i-- > 0;) {
      const auto index = as_index(references[i]);
      if (!index || *index >= reached.size()) {
        return fail_at_place(Error::BadValue, source, place_of(place, i), "no such node");
      }
      pending.push_back({*index, parent, is_hidden});
    }
    return Done{};
  };
  const Result<Roots> roots = root_nodes(source, json);
  if (!roots.ok()) return roots.failure();
  Status begun = push_all(roots->nodes, roots->nodes.size(), roots->place, {}, false);
  if (!begun.ok()) return begun.failure();
  if (roots->nodes.empty()) {
    return fail_at_place(Error::NoTriangles, source, roots->place,
                         "no node to begin with: the scene is empty or every node is a child");
  }

  std::size_t skinned = 0, hidden = 0;
  while (!pending.empty()) {
    const Pending current = pending.back();
    pending.pop_back();
    const std::string place = place_of("nodes", current.node);
    if (reached[current.node]) {
      return fail_at_place(Error::BadValue, source, place,
                           "reached twice: a loop, or a node with two parents");
    }
    reached[current.node] = true;
    const Json& node = nodes[current.node];
    Result<Transform> local = local_transform(source, node, place);
    if (!local.ok()) return local.failure();
    const Transform to_world = current.parent.after(*local);
    scene.to_world_of_node[current.node] = to_world;
    const Json& extensions = at(node, "extensions");
    const Json& visible = at(at(extensions, "KHR_node_visibility"), "visible");
    const bool is_hidden = current.is_hidden || (visible.is_boolean() && !visible.get<bool>());
    if (is_hidden && !at(node, "mesh").is_null()) {
      ++hidden;
    } else if (!at(node, "mesh").is_null()) {
      const auto mesh = as_index(at(node, "mesh"));
      if (!mesh || *mesh >= size_of(meshes)) {
        return fail_at_place(Error::BadValue, source, place + ".mesh", "no such mesh");
      }
      const std::string otherwise = name_of(meshes[*mesh], "node " + std::to_string(current.node));
      scene.instances.push_back({*mesh, to_world, name_of(node, otherwise),
                                 weights_of(meshes[*mesh], node), as_index(at(node, "skin")),
                                 has_name(node) || has_name(meshes[*mesh])});
      if (scene.instances.back().skin) ++skinned;
      if (at(extensions, "EXT_mesh_gpu_instancing").is_object()) {
        scene.instances.back().instanced_node = current.node;
      }
    }
    const Json& children = at(node, "children");
    Status pushed = push_all(children, size_of(children), place + ".children", to_world, is_hidden);
    if (!pushed.ok()) return pushed.failure();
  }
  tell_left_out(json, reached, scene.notes);
  if (skinned > 0) {
    place_others(source, nodes, scene.to_world_of_node);
    scene.notes.push_back(
        (skinned == 1 ? "a skinned mesh" : std::to_string(skinned) + " skinned meshes") +
        std::string(" taken as the joints stand, without joints and weights"));
  }
  if (hidden > 0) {
    scene.notes.push_back(std::to_string(hidden) +
                          " nodes that KHR_node_visibility hides left out");
  }
  return scene;
}

}  // namespace crease

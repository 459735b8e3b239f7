// glTF 2.0: .gltf, .glb, and the GLB inside a .b3dm. Coordinates stay as they are (y up, but for
// files of this program that say otherwise).
#include "io/gltf_attributes.h"
#include "io/gltf_compression.h"
#include "io/gltf_document.h"
#include "io/gltf_images.h"
#include "io/gltf_instancing.h"
#include "io/gltf_materials.h"
#include "io/gltf_scene.h"
#include "io/gltf_skin.h"
#include "io/gltf_used_vertices.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crease {
namespace {

// 3.7.2.1: primitive.mode.
enum class Mode : std::size_t { Triangles = 4, Strip = 5, Fan = 6 };

// 3.7.2.2: what morph targets move, of what is kept.
bool is_morphed(const std::string& semantic) {
  return semantic == "POSITION" || semantic == "NORMAL" || semantic.starts_with("TEXCOORD_") ||
         semantic.starts_with("COLOR_");
}

// Appends the triangles that a run of vertices makes. `vertex(i)` is the i-th.
template <typename Vertex>
void add_triangles(Mode mode, std::size_t count, bool mirrored, Vertex vertex,
                   std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (mirrored) std::swap(b, c);
    triangles.push_back({vertex(a), vertex(b), vertex(c)});
  };
  switch (mode) {
    case Mode::Triangles:
      for (std::size_t i = 0; i + 3 <= count; i += 3) add(i, i + 1, i + 2);
      break;
    case Mode::Strip:
      for (std::size_t i = 0; i + 3 <= count; ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
      break;
    case Mode::Fan:
      for (std::size_t i = 1; i + 2 <= count; ++i) add(i, i + 1, 0);
      break;
  }
}

class MeshBuilder {
 public:
  MeshBuilder(const Source& source, const GltfDocument& document)
      : source_(source),
        json_(document.json),
        center_(document.center),
        reader_(source, document),
        layers_(source),
        skins_(document.json, reader_) {
    raw_.report.notes = document.notes;
  }

  Result<RawMesh> build() {
    Result<GltfScene> scene = walk_scene(source_, json_);
    if (!scene.ok()) return scene.failure();
    std::ranges::copy(scene->notes, std::back_inserter(raw_.report.notes));
    GltfImages images(source_, json_, reader_);
    GltfMaterials materials = read_gltf_materials(json_, images);
    raw_.materials = std::move(materials.materials);
    raw_.images = std::move(images.images);
    std::ranges::copy(images.notes, std::back_inserter(raw_.report.notes));
    std::ranges::copy(materials.notes, std::back_inserter(raw_.report.notes));
    raw_.up = as_text(at(at(at(json_, "asset"), "extras"), "up")) == "z" ? UpAxis::Z : UpAxis::Y;
    raw_.default_normals = {NormalPolicy::Kind::Flat, 0};
    // The only one is a part for its name's sake.
    const bool has_parts = scene->instances.size() > 1 ||
                           (scene->instances.size() == 1 && scene->instances[0].is_named);

    const Json& meshes = at(json_, "meshes");
    std::vector<std::map<Weights, std::vector<Instance>>> instances_of_mesh(size_of(meshes));
    for (const MeshInstance& instance : scene->instances) {
      const auto part = static_cast<PartId>(raw_.parts.size());
      Instance whole{part, instance.to_world};
      if (instance.skin) whole = {part, {}, &skins_.joints_of(*instance.skin, *scene)};
      std::vector<Instance>& instances = instances_of_mesh[instance.mesh][instance.weights];
      const Status placed = place(instance, whole, instances);
      if (!placed.ok()) return placed.failure();
      if (has_parts) raw_.parts.push_back(instance.name);
    }
    for (std::size_t m = 0; m < instances_of_mesh.size(); ++m) {
      if (instances_of_mesh[m].empty()) continue;
      const Json& primitives = at(meshes[m], "primitives");
      for (std::size_t p = 0; p < size_of(primitives); ++p) {
        const std::string place = place_of(place_of("meshes", m) + ".primitives", p);
        for (const auto& [weights, instances] : instances_of_mesh[m]) {
          Status added = add_primitive(primitives[p], place, weights, instances);
          if (!added.ok()) return added.failure();
        }
      }
      if (interrupted(double(m + 1) / double(instances_of_mesh.size()))) {
        return fail(Error::Interrupted, source_.name + ": interrupted");
      }
    }
    if (raw_.triangles.empty() && unplaced_primitives_ > 0) {
      return fail_at_place(Error::BadFormat, source_, first_missing_position_, "missing");
    }
    if (!has_parts) raw_.part_of_triangle.clear();
    finish_materials();
    layers_.finish(raw_);
    add_notes();
    return std::move(raw_);
  }

 private:
  using Weights = std::vector<double>;  // of morph targets

  struct Instance {
    PartId part{};
    Transform to_world;
    const std::vector<Transform>* joints = nullptr;  // of a skin, after that
  };

  // Once, or as often as its node's EXT_mesh_gpu_instancing says.
  Status place(const MeshInstance& instance, const Instance& whole,
               std::vector<Instance>& instances) {
    if (!instance.instanced_node) {
      instances.push_back(whole);
      return Done{};
    }
    constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
    const Json& node = at(at(json_, "nodes"), *instance.instanced_node);
    const std::string here =
        place_of("nodes", *instance.instanced_node) + ".extensions." + kInstancing;
    const auto transforms =
        read_instancing(source_, at(at(node, "extensions"), kInstancing), reader_,
                        most_values() - instanced_, here, ignored_of_instances_);
    if (!transforms.ok()) return transforms.failure();
    instanced_ += transforms->size();
    for (const Transform& transform : *transforms) {
      instances.push_back({whole.part, whole.to_world.after(transform), whole.joints});
    }
    return Done{};
  }

  // `weights`, which the placements refer to, are those of the primitive.
  Result<std::vector<Placement>> placements_of(const std::vector<Instance>& instances,
                                               const Json& attributes, const std::string& place,
                                               std::size_t vertex_count, JointWeights& weights) {
    std::vector<Placement> placements;
    bool is_read = false;
    for (const Instance& instance : instances) {
      if (instance.joints == nullptr) {
        placements.emplace_back(instance.to_world);
        continue;
      }
      if (!is_read) {
        auto read = read_joint_weights(source_, reader_, attributes, place, vertex_count);
        if (!read.ok()) return read.failure();
        weights = *std::move(read);
        is_read = true;
        if (weights.empty()) ++unweighted_primitives_;
      }
      const Status in_skin = check_joints(source_, weights, instance.joints->size(), place);
      if (!in_skin.ok()) return in_skin.failure();
      placements.emplace_back(instance.to_world, *instance.joints, weights);
    }
    return placements;
  }

  // `instances` have these weights.
  Status add_primitive(const Json& primitive, const std::string& place, const Weights& weights,
                       const std::vector<Instance>& instances) {
    const std::size_t mode = as_index(at(primitive, "mode")).value_or(4);
    if (mode < 4) {
      ++point_and_line_primitives_;
      return Done{};
    }
    if (mode > 6) return fail_at_place(Error::BadValue, source_, place + ".mode", "unknown");
    const Json& attributes = at(primitive, "attributes");
    const std::string attributes_place = place + ".attributes";
    const std::string position_place = attributes_place + ".POSITION";
    if (at(attributes, "POSITION").is_null()) {  // 3.7.2.1: to be skipped
      if (unplaced_primitives_++ == 0) first_missing_position_ = position_place;
      return Done{};
    }
    reader_.forget_given();
    Status decompressed = decompress(primitive, place);
    if (!decompressed.ok()) return decompressed;
    Status morphed = morph(primitive, place, weights);
    if (!morphed.ok()) return morphed;
    auto positions = reader_.floats(at(attributes, "POSITION"), 3, 3, position_place);
    if (!positions.ok()) return positions.failure();
    std::size_t vertex_count = positions->count();

    std::vector<std::uint32_t> indices;
    const bool indexed = !at(primitive, "indices").is_null();
    if (indexed) {
      auto read = reader_.indices(at(primitive, "indices"), place + ".indices");
      if (!read.ok()) return read.failure();
      indices = *std::move(read);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < vertex_count) continue;
        return fail_at_place(Error::BadValue, source_, place_of(place + ".indices", i),
                             "index " + std::to_string(indices[i]) + " of " +
                                 std::to_string(vertex_count) + " vertices");
      }
    }
    const std::size_t run = indexed ? indices.size() : vertex_count;
    if (mode == 4 && run % 3 != 0) ++odd_runs_;
    const std::vector<std::uint32_t> used =
        keep_used_vertices(attributes, vertex_count, indices, reader_);
    if (!used.empty()) {
      positions = reader_.floats(at(attributes, "POSITION"), 3, 3, position_place);
      if (!positions.ok()) return positions.failure();
      work_ += vertex_count;
      vertex_count = used.size();
    }
    if (!within_limit(instances.size(), vertex_count, run)) {
      return fail_at_place(Error::OverLimit, source_, place,
                           "instances and shared accessors multiply the file beyond reason");
    }

    JointWeights joint_weights;
    const auto placements =
        placements_of(instances, attributes, attributes_place, vertex_count, joint_weights);
    if (!placements.ok()) return placements.failure();

    const std::size_t first_vertex = raw_.positions.size();
    const std::size_t first_triangle = raw_.triangles.size();
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const auto base = static_cast<std::uint32_t>(raw_.positions.size());
      const auto mirrored = add_positions(*positions, used, (*placements)[i], position_place);
      if (!mirrored.ok()) return mirrored.failure();
      const auto vertex = [&](std::size_t c) {
        return base + (indexed ? indices[c] : static_cast<std::uint32_t>(c));
      };
      add_triangles(static_cast<Mode>(mode), run, *mirrored, vertex, raw_.triangles);
      raw_.part_of_triangle.resize(raw_.triangles.size(), instances[i].part);
    }
    if (raw_.positions.size() == first_vertex) return Done{};
    const auto material = as_index(at(primitive, "material"));
    const Json& entry = at(at(json_, "materials"), material.value_or(std::size_t(-1)));
    Status added = layers_.add(reader_, attributes, attributes_place, vertex_count, *placements,
                               texture_use(base_color_texture(entry)));
    if (!added.ok()) return added;
    return add_material(primitive, place, raw_.triangles.size() - first_triangle);
  }

  // True if the placement mirrors: if most vertices are, as a primitive has one winding (3.7.4).
  // `used`: which of the accessor's they are, or empty: all.
  Result<bool> add_positions(const GltfReader::Floats& positions,
                             std::span<const std::uint32_t> used, const Placement& placement,
                             const std::string& place) {
    Transform to_world;
    bool is_mirrored = false;
    std::size_t mirrored_count = 0;
    for (std::size_t v = 0; v < positions.count(); ++v) {
      const float* stored = &positions.values[3 * v];
      if (v == 0 || placement.has_joints()) {
        to_world = placement.of(v);
        is_mirrored = to_world.determinant() < 0;
      }
      const Vec3d p = to_world.point({stored[0], stored[1], stored[2]}) + center_;
      if (!is_position(p)) {
        return fail_at_place(Error::BadValue, source_, place_of(place, used.empty() ? v : used[v]),
                             std::string("position is ") + fault_of(p));
      }
      raw_.positions.push_back(p);
      if (is_mirrored) ++mirrored_count;
    }
    return 2 * mirrored_count > positions.count();
  }

  // What KHR_draco_mesh_compression holds of a primitive takes the place of its accessors' values,
  // if they have none.
  Status decompress(const Json& primitive, const std::string& place) {
    const Json& draco = at(at(primitive, "extensions"), "KHR_draco_mesh_compression");
    const Json& accessors = at(json_, "accessors");
    const auto position = as_index(at(at(primitive, "attributes"), "POSITION"));
    if (!draco.is_object() || !position || *position >= size_of(accessors)) return Done{};
    if (at(accessors[*position], "bufferView").is_number()) return Done{};
    const std::string here = place + ".extensions.KHR_draco_mesh_compression";
    const auto encoded = reader_.view_bytes(at(draco, "bufferView"), here);
    if (!encoded.ok()) return encoded.failure();
    std::vector<std::uint32_t> ids;
    std::vector<std::size_t> targets;
    const Json& of_draco = at(draco, "attributes");
    for (auto it = of_draco.begin(); of_draco.is_object() && it != of_draco.end(); ++it) {
      const auto id = as_index(it.value());
      const auto accessor = as_index(at(at(primitive, "attributes"), it.key().c_str()));
      if (!id || *id > kNone || !accessor) {
        return fail_at_place(Error::BadValue, source_, here + ".attributes", in_quotes(it.key()));
      }
      ids.push_back(static_cast<std::uint32_t>(*id));
      targets.push_back(*accessor);
    }
    Result<DracoPrimitive> decoded = decode_draco(source_, here, *encoded, ids, most_values());
    if (!decoded.ok()) return decoded.failure();
    bool is_miscounted = false;
    const auto compare = [&](std::size_t accessor, std::size_t count) {
      is_miscounted |= as_index(at(at(accessors, accessor), "count")) != count;
    };
    for (std::size_t i = 0; i < targets.size(); ++i) {
      compare(targets[i], decoded->vertex_count);
      reader_.give(targets[i], std::move(decoded->attributes[i]));
    }
    if (const auto indices = as_index(at(primitive, "indices"))) {
      compare(*indices, decoded->indices.size());
      reader_.give(*indices, std::move(decoded->indices));
    }
    if (is_miscounted) ++miscounted_primitives_;
    return Done{};
  }

  // 3.7.2.2: what the weights make of a primitive takes the place of its accessors' values.
  Status morph(const Json& primitive, const std::string& place, const Weights& weights) {
    const Json& targets = at(primitive, "targets");
    const Json& attributes = at(primitive, "attributes");
    if (size_of(targets) > 0) ++morphed_primitives_;
    std::vector<std::pair<std::size_t, GltfReader::Floats>> all_moved;
    for (auto it = attributes.begin(); attributes.is_object() && it != attributes.end(); ++it) {
      const std::string& semantic = it.key();
      const auto accessor = as_index(it.value());
      const std::size_t components = reader_.components_of(it.value());
      if (!is_morphed(semantic) || components == 0) continue;
      std::optional<GltfReader::Floats> moved;
      for (std::size_t k = 0; k < std::min(size_of(targets), weights.size()); ++k) {
        const Json& target = at(targets[k], semantic.c_str());
        if (weights[k] == 0 || target.is_null()) continue;
        if (!moved) {
          auto base =
              reader_.floats(it.value(), components, components, place + ".attributes." + semantic);
          if (!base.ok()) return base.failure();
          moved = *std::move(base);
          moved->is_worked_out = true;
        }
        const std::string here = place_of(place + ".targets", k) + "." + semantic;
        const auto offset = reader_.floats(target, components, components, here);
        if (!offset.ok()) return offset.failure();
        if (offset->values.size() != moved->values.size()) {
          return fail_at_place(Error::BadValue, source_, here, "not a value for every vertex");
        }
        if (!within_limit(1, offset->count(), 0)) {
          return fail_at_place(Error::OverLimit, source_, here,
                               "shared accessors multiply the file beyond reason");
        }
        for (std::size_t i = 0; i < moved->values.size(); ++i) {
          moved->values[i] += static_cast<float>(weights[k]) * offset->values[i];
        }
      }
      if (!moved) continue;
      if (semantic.starts_with("COLOR_")) {
        for (float& x : moved->values) x = std::clamp(x, 0.0f, 1.0f);
      }
      all_moved.emplace_back(*accessor, *std::move(moved));
    }
    // Only now, as attributes may share an accessor, which is moved once.
    for (auto& [accessor, moved] : all_moved) reader_.give(accessor, std::move(moved));
    return Done{};
  }

  Status add_material(const Json& primitive, const std::string& place, std::size_t count) {
    std::uint32_t material = kNone;  // none given: settled at the end
    if (!at(primitive, "material").is_null()) {
      const auto index = as_index(at(primitive, "material"));
      if (!index || *index >= raw_.materials.size()) {
        return fail_at_place(Error::BadValue, source_, place + ".material", "no such material");
      }
      material = static_cast<std::uint32_t>(*index);
    }
    material_of_triangle_.resize(material_of_triangle_.size() + count, material);
    return Done{};
  }

  // Triangles without a material get one of their own if others have one.
  void finish_materials() {
    if (raw_.materials.empty()) return;
    const auto fallback = static_cast<std::uint32_t>(raw_.materials.size());
    bool used = false;
    for (std::uint32_t material : material_of_triangle_) {
      used |= material == kNone;
      raw_.material_of_triangle.push_back(
          static_cast<MaterialId>(material == kNone ? fallback : material));
    }
    if (used) raw_.materials.push_back({.name = "default", .base_color_texture = {}});
  }

  // Nodes share meshes and primitives share accessors, so a small file can ask for any amount of
  // memory. A thousand times what there is to read is more than instancing needs.
  std::size_t most_values() {
    return std::min<std::size_t>((std::size_t(1) << 20) + 1000 * reader_.input_bytes(),
                                 std::size_t(1) << 28);
  }
  bool within_limit(std::size_t instance_count, std::size_t vertex_count, std::size_t run) {
    const std::size_t budget = most_values();
    const std::size_t largest = std::max(vertex_count, run);
    if (largest > budget || instance_count > budget / std::max<std::size_t>(largest, 1)) {
      return false;
    }
    work_ += instance_count * largest;
    return work_ <= budget && layers_.value_count() <= 8 * budget;
  }

  bool interrupted(double done) const {
    return source_.progress != nullptr && *source_.progress &&
           !(*source_.progress)("reading", done);
  }

  void add_notes() {
    const auto note = [&](std::size_t count, const std::string& what) {
      if (count > 0) raw_.report.notes.push_back(std::to_string(count) + " " + what);
    };
    note(point_and_line_primitives_, "primitives of points or lines ignored");
    note(unplaced_primitives_, "primitives without POSITION ignored");
    note(miscounted_primitives_,
         "primitives whose accessors' counts are not those of what Draco holds, which is taken");
    note(morphed_primitives_,
         "primitives with morph targets taken as their weights are, at rest without");
    note(unweighted_primitives_,
         "primitives without JOINTS_0 and WEIGHTS_0 taken as the first joint of their skin moves "
         "them");
    note(skins_.broken_joints(),
         "joints of skins move nothing: there is no such node, or no inverse bind matrix");
    note(odd_runs_, "primitives whose index count is no multiple of three; the rest is ignored");
    note(size_of(at(json_, "animations")), "animations ignored");
    note(size_of(at(json_, "cameras")), "cameras ignored");
    for (const auto& [name, count] : ignored_of_instances_) {
      note(count, "nodes have instances whose " + in_quotes(name) + " is ignored");
    }
    const Json& extensions = at(json_, "extensions");
    note(size_of(at(at(extensions, "KHR_lights_punctual"), "lights")), "lights ignored");
    note(size_of(at(at(extensions, "KHR_materials_variants"), "variants")),
         "variants of materials ignored: the ones that primitives name are taken");
    note(size_of(at(at(extensions, "EXT_structural_metadata"), "propertyTables")),
         "tables of EXT_structural_metadata ignored: feature ids are kept, what they stand for is "
         "not");
  }

  const Source& source_;
  const Json& json_;
  Vec3d center_;
  GltfReader reader_;
  GltfLayers layers_;
  GltfSkins skins_;
  RawMesh raw_;
  std::vector<std::uint32_t> material_of_triangle_;
  std::map<std::string, std::size_t> ignored_of_instances_;  // attribute: nodes that have it
  std::size_t work_ = 0, instanced_ = 0;
  std::size_t point_and_line_primitives_ = 0, morphed_primitives_ = 0, odd_runs_ = 0;
  std::size_t unweighted_primitives_ = 0, unplaced_primitives_ = 0, miscounted_primitives_ = 0;
  std::string first_missing_position_;  // of the latter
};

}  // namespace

Result<RawMesh> read_gltf(const Source& source) {
  Result<GltfDocument> document = open_gltf(source);
  if (!document.ok()) return document.failure();
  Status supported = check_required_extensions(source, document->json);
  if (!supported.ok()) return supported.failure();
  Result<RawMesh> raw = MeshBuilder(source, *document).build();
  if (raw.ok()) raw->report.format = document->format;
  return raw;
}

}  // namespace crease

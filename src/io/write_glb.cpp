// GLB: one primitive for every part and material, split vertices, floats around one translation,
// images behind them.
#include "crease/export.h"
#include "io/float_positions.h"
#include "io/formats.h"
#include "io/glb_materials.h"
#include "io/glb_streams.h"
#include "io/split_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace crease {
namespace {

using Json = nlohmann::ordered_json;  // members in the order they are written

constexpr std::uint32_t kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint32_t kUnsignedInts = 5125;
constexpr const char* kGenerator = "crease";

// The faces' own normals: what a mesh without normals means in glTF, made explicit.
AttributeLayer flat_normals(const Mesh& mesh) {
  AttributeLayer layer{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](std::size_t c) {
      return mesh.positions[index_of(mesh.triangles[t][c])];
    };
    const Vec3d n = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
    for (int k = 0; k < 3; ++k) layer.values.push_back(static_cast<float>(n[k]));
    layer.of_corner.insert(layer.of_corner.end(), 3, static_cast<AttributeId>(t));
  }
  return layer;
}

class GlbWriter {
 public:
  // Adds a mesh and returns its root node.
  Result<std::size_t> add(const Mesh& mesh) {
    if (mesh.triangles.empty()) return fail(Error::NoTriangles, "nothing to write");
    std::vector<const AttributeLayer*> layers;
    AttributeLayer flat;
    if (mesh.normals() == nullptr) {
      flat = flat_normals(mesh);
      layers.push_back(&flat);
    }
    for (const AttributeLayer& layer : mesh.layers) layers.push_back(&layer);
    is_z_up_ = is_z_up_ || mesh.up == UpAxis::Z;
    const SplitVertices split = split_vertices(mesh, layers);
    const std::vector<std::size_t> streams = streams_of(layers);
    const Vec3d origin = middle_origin(mesh);
    const std::vector<std::size_t> materials = materials_.add(mesh);

    Json root = Json::object(), children = Json::array();
    if (origin != Vec3d{}) root["translation"] = std::array{origin.x, origin.y, origin.z};
    Job job{mesh, split, layers, streams, origin, {}};
    job.local_index.assign(split.count(), kNone);

    const std::vector<std::uint32_t> order = triangles_by_part_and_material(mesh);
    for (std::size_t begin = 0; begin < order.size();) {
      const std::uint32_t part = part_of(mesh, order[begin]);
      Json primitives = Json::array();
      while (begin < order.size() && part_of(mesh, order[begin]) == part) {
        const std::uint32_t material = material_of(mesh, order[begin]);
        std::size_t end = begin;
        while (end < order.size() && part_of(mesh, order[end]) == part &&
               material_of(mesh, order[end]) == material) {
          ++end;
        }
        Json primitive = add_primitive(job, std::span(order).subspan(begin, end - begin));
        if (material != kNone) primitive["material"] = materials[material];
        primitives.push_back(std::move(primitive));
        begin = end;
      }
      const bool named = part != kNone && part < mesh.parts.size() && !mesh.parts[part].empty();
      Json gltf_mesh = Json::object();
      if (named) gltf_mesh["name"] = mesh.parts[part];
      gltf_mesh["primitives"] = std::move(primitives);
      meshes_.push_back(std::move(gltf_mesh));
      Json node = Json::object();
      if (named) node["name"] = mesh.parts[part];
      node["mesh"] = meshes_.size() - 1;
      const bool only_part = begin == order.size() && children.empty();
      if (only_part) {
        root.update(node);
      } else {
        nodes_.push_back(std::move(node));
        children.push_back(nodes_.size() - 1);
      }
    }
    if (!children.empty()) root["children"] = std::move(children);
    nodes_.push_back(std::move(root));
    return nodes_.size() - 1;
  }

  Json& node(std::size_t index) { return nodes_[index]; }
  void use_extension(const char* name) { extensions_.push_back(name); }

  // The file, with one scene of one root node.
  Result<std::vector<std::byte>> finish(std::size_t root) {
    Json json = Json::object();
    json["asset"] = {{"version", "2.0"}, {"generator", kGenerator}};
    // Coordinates stay as they are, whatever glTF says of them; so that we at least know again.
    if (is_z_up_) json["asset"]["extras"] = {{"up", "z"}};
    if (!extensions_.empty()) json["extensionsUsed"] = extensions_;
    json["scene"] = 0;
    Json scene = Json::object();
    scene["nodes"] = Json::array();
    scene["nodes"].push_back(root);
    json["scenes"] = Json::array();
    json["scenes"].push_back(std::move(scene));
    json["nodes"] = std::move(nodes_);
    json["meshes"] = std::move(meshes_);

    // Views of four-byte values first, so that each begins at a multiple of four (3.6.2.4).
    Json views = Json::array();
    std::size_t length = 0;
    const auto add_view = [&](std::size_t bytes, std::size_t stride, std::uint32_t target) {
      Json view = {{"buffer", 0}, {"byteOffset", length}, {"byteLength", bytes}};
      if (stride > 0) view["byteStride"] = stride;
      view["target"] = target;
      views.push_back(std::move(view));
      length += bytes;
      return views.size() - 1;
    };
    std::vector<std::size_t> view_of_stream;
    for (const GlbStream& stream : streams_) {
      view_of_stream.push_back(
          add_view(stream.bytes.size(), stream.semantic.stride(), kArrayBuffer));
    }
    std::size_t wide_view = 0, narrow_view = 0;
    if (!wide_.empty()) wide_view = add_view(wide_.size() * 4, 0, kElementArrayBuffer);
    if (!narrow_.empty()) narrow_view = add_view(narrow_.size() * 2, 0, kElementArrayBuffer);
    for (std::size_t a = 0; a < accessors_.size(); ++a) {
      const std::size_t stream = stream_of_accessor_[a];
      accessors_[a]["bufferView"] = stream == kNarrow ? narrow_view
                                    : stream == kWide ? wide_view
                                                      : view_of_stream[stream];
    }
    materials_.write(json, views, length);
    json["accessors"] = std::move(accessors_);
    json["bufferViews"] = std::move(views);
    json["buffers"] = Json::array();
    json["buffers"].push_back({{"byteLength", length}});
    return put_together(json, length);
  }

 private:
  static constexpr std::size_t kNarrow = std::size_t(-1), kWide = std::size_t(-2);

  struct Job {
    const Mesh& mesh;
    const SplitVertices& split;
    const std::vector<const AttributeLayer*>& layers;
    const std::vector<std::size_t>& streams;  // of positions, then of each layer
    Vec3d origin;
    std::vector<std::uint32_t> local_index;  // per split vertex: in this primitive, or kNone
  };

  static std::uint32_t part_of(const Mesh& mesh, std::uint32_t t) {
    return mesh.part_of_triangle.empty() ? kNone
                                         : static_cast<std::uint32_t>(mesh.part_of_triangle[t]);
  }
  static std::uint32_t material_of(const Mesh& mesh, std::uint32_t t) {
    return mesh.material_of_triangle.empty()
               ? kNone
               : static_cast<std::uint32_t>(mesh.material_of_triangle[t]);
  }

  static std::vector<std::uint32_t> triangles_by_part_and_material(const Mesh& mesh) {
    std::vector<std::uint32_t> order(mesh.triangle_count());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t t) {
      return std::pair(part_of(mesh, t), material_of(mesh, t));
    });
    return order;
  }

  // Levels of one asset have the same layers, so they share streams.
  std::vector<std::size_t> streams_of(std::span<const AttributeLayer* const> layers) {
    std::vector<GlbSemantic> semantics = {{"POSITION", 3, AttributeRole::Other}};
    for (GlbSemantic& semantic : semantics_of(layers)) semantics.push_back(std::move(semantic));
    std::vector<std::size_t> result;
    for (GlbSemantic& semantic : semantics) {
      const auto found = std::ranges::find(streams_, semantic, &GlbStream::semantic);
      result.push_back(static_cast<std::size_t>(found - streams_.begin()));
      if (found == streams_.end()) streams_.push_back({std::move(semantic), {}});
    }
    return result;
  }

  Json add_primitive(Job& job, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> vertices;  // split vertices in order of first use
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * triangles.size());
    for (std::uint32_t t : triangles) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t s = job.split.of_corner[3 * t + c];
        if (job.local_index[s] == kNone) {
          job.local_index[s] = static_cast<std::uint32_t>(vertices.size());
          vertices.push_back(s);
        }
        indices.push_back(job.local_index[s]);
      }
    }
    for (std::uint32_t s : vertices) job.local_index[s] = kNone;

    Json attributes = Json::object();
    attributes["POSITION"] = add_positions(job, vertices);
    for (std::size_t l = 0; l < job.layers.size(); ++l) {
      GlbStream& stream = streams_[job.streams[l + 1]];
      const std::size_t offset = stream.bytes.size();
      for (std::uint32_t s : vertices) {
        stream.add(job.layers[l]->value(job.split.values[l][s]));
      }
      attributes[stream.semantic.name] =
          add_accessor(job.streams[l + 1], offset, stream.semantic.component_type, vertices.size(),
                       stream.semantic.dimension);
    }
    return {{"attributes", std::move(attributes)},
            {"indices", add_indices(indices, vertices.size())}};
  }

  std::size_t add_positions(const Job& job, const std::vector<std::uint32_t>& vertices) {
    GlbStream& stream = streams_[job.streams[0]];
    const std::size_t offset = stream.bytes.size();
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (std::uint32_t s : vertices) {
      const Vec3d p = job.mesh.positions[job.split.position[s]] - job.origin;
      std::array<float, 3> place;
      for (std::size_t k = 0; k < 3; ++k) {
        place[k] = static_cast<float>(p[static_cast<int>(k)]);
        low[k] = std::min(low[k], place[k]);
        high[k] = std::max(high[k], place[k]);
      }
      stream.add_as_is(place);
    }
    const std::size_t accessor =
        add_accessor(job.streams[0], offset, kGlbFloats, vertices.size(), 3);
    accessors_[accessor]["min"] = low;
    accessors_[accessor]["max"] = high;
    return accessor;
  }

  // The largest 16-bit index means "restart" (3.7.2.1), so 65535 vertices are the most.
  std::size_t add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
    if (vertex_count > 65535) {
      const std::size_t offset = wide_.size() * 4;
      wide_.insert(wide_.end(), indices.begin(), indices.end());
      return add_accessor(kWide, offset, kUnsignedInts, indices.size(), 1);
    }
    const std::size_t offset = narrow_.size() * 2;
    for (std::uint32_t i : indices) narrow_.push_back(static_cast<std::uint16_t>(i));
    return add_accessor(kNarrow, offset, kGlbUnsignedShorts, indices.size(), 1);
  }

  // The bufferView is known at the end, when the streams have their sizes.
  std::size_t add_accessor(std::size_t stream, std::size_t offset, std::uint32_t type,
                           std::size_t count, std::uint32_t dimension) {
    static constexpr std::array kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    accessors_.push_back({{"bufferView", 0},
                          {"byteOffset", offset},
                          {"componentType", type},
                          {"count", count},
                          {"type", kTypes[dimension - 1]}});
    stream_of_accessor_.push_back(stream);
    return accessors_.size() - 1;
  }

  Result<std::vector<std::byte>> put_together(const Json& json, std::size_t length) const {
    // Names may be in any encoding; what is not UTF-8 is replaced.
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t padded = (length + 3) / 4 * 4;
    const std::size_t total = 12 + 8 + text.size() + 8 + padded;
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      return fail(Error::OverLimit, "a GLB holds at most 4 GiB, this would be " +
                                        std::to_string(total) + " bytes; write a coarser level");
    }
    std::vector<std::byte> bytes(total);
    std::byte* to = bytes.data();
    const auto put = [&](const void* from, std::size_t size) {
      if (size > 0) std::memcpy(to, from, size);
      to += size;
    };
    const auto put_u32 = [&](std::size_t value) {
      for (int shift = 0; shift < 32; shift += 8) *to++ = std::byte(value >> shift & 0xff);
    };
    put("glTF", 4);
    put_u32(2);
    put_u32(total);
    put_u32(text.size());
    put("JSON", 4);
    put(text.data(), text.size());
    put_u32(padded);
    put("BIN", 4);  // with its zero
    for (const GlbStream& stream : streams_) {
      put(stream.bytes.data(), stream.bytes.size());
    }
    put(wide_.data(), wide_.size() * 4);
    put(narrow_.data(), narrow_.size() * 2);
    for (const ImageFile& image : materials_.images()) {
      put(image.bytes->data(), image.bytes->size());
    }
    return bytes;
  }

  std::vector<GlbStream> streams_;
  std::vector<std::uint32_t> wide_;
  std::vector<std::uint16_t> narrow_;
  GlbMaterials materials_;
  Json accessors_ = Json::array(), nodes_ = Json::array(), meshes_ = Json::array();
  std::vector<std::size_t> stream_of_accessor_;
  std::vector<std::string> extensions_;
  bool is_z_up_ = false;
};

}  // namespace

Result<std::vector<std::byte>> write_glb(const Mesh& mesh) {
  GlbWriter writer;
  const Result<std::size_t> root = writer.add(mesh);
  if (!root.ok()) return root.failure();
  return writer.finish(*root);
}

// MSFT_lod: the finest node lists the coarser ones, which no scene refers to.
Result<std::vector<std::byte>> export_lod_glb(std::span<const Mesh> levels_finest_first,
                                              std::span<const double> screen_coverage) {
  if (levels_finest_first.empty()) return fail(Error::NoTriangles, "no level to write");
  if (!screen_coverage.empty() && screen_coverage.size() != levels_finest_first.size()) {
    return fail(Error::BadValue, std::to_string(screen_coverage.size()) + " screen coverages for " +
                                     std::to_string(levels_finest_first.size()) + " levels");
  }
  GlbWriter writer;
  std::vector<std::size_t> roots;
  for (const Mesh& level : levels_finest_first) {
    const Result<std::size_t> root = writer.add(level);
    if (!root.ok()) return root.failure();
    roots.push_back(*root);
  }
  if (roots.size() > 1) {
    writer.use_extension("MSFT_lod");
    const std::vector<std::size_t> coarser(roots.begin() + 1, roots.end());
    writer.node(roots[0])["extensions"] = {{"MSFT_lod", {{"ids", coarser}}}};
  }
  if (!screen_coverage.empty()) {
    writer.node(roots[0])["extras"] = {
        {"MSFT_screencoverage",
         std::vector<double>(screen_coverage.begin(), screen_coverage.end())}};
  }
  return writer.finish(roots[0]);
}

}  // namespace crease

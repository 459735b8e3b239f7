#include "cli/facts.h"

#include "cli/fields.h"
#include "cli/up_option.h"
#include "crease/shading.h"

#include <algorithm>

namespace crease::cli {

namespace {

const char* name_of(AttributeRole role) {
  switch (role) {
    case AttributeRole::Normal:
      return "normal";
    case AttributeRole::TexCoord:
      return "texcoord";
    case AttributeRole::Color:
      return "color";
    case AttributeRole::Other:
      return "other";
  }
  return "";
}

const char* name_of(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::Direction:
      return "direction";
    case Interpolation::Linear:
      return "linear";
    case Interpolation::Categorical:
      return "categorical";
  }
  return "";
}

Json attributes_json(const std::vector<LayerSchema>& layers) {
  Json attributes = Json::array();
  for (const LayerSchema& layer : layers) {
    attributes.push_back({{"name", layer.name},
                          {"role", name_of(layer.role)},
                          {"interpolation", name_of(layer.interpolation)},
                          {"dimension", layer.dimension}});
  }
  return attributes;
}

Json attributes_json(const Mesh& mesh) {
  Json attributes = Json::array();
  for (const AttributeLayer& layer : mesh.layers) {
    attributes.push_back({{"name", layer.name},
                          {"role", name_of(layer.role)},
                          {"interpolation", name_of(layer.interpolation)},
                          {"dimension", layer.dimension},
                          {"values", layer.value_count()}});
  }
  return attributes;
}

Json bounds_json(const Mesh& mesh) {
  if (mesh.positions.empty()) return nullptr;
  const auto [low, high] = bounds_of(mesh);
  return {{"low", {low.x, low.y, low.z}}, {"high", {high.x, high.y, high.z}}};
}

Json bits_json(const BitsPerVertex& bits) {
  return {{"total", bits.total},
          {"connectivity", bits.connectivity},
          {"positions", bits.positions},
          {"attributes", bits.attributes}};
}

Json streams_json(const StreamBits& bits) {
  return {{"roots", bits.roots},         {"flags", bits.flags},           {"shapes", bits.shapes},
          {"positions", bits.positions}, {"categories", bits.categories}, {"values", bits.values},
          {"labels", bits.labels}};
}

StreamBits sum_of(const std::vector<StreamBits>& all) {
  StreamBits sum;
  for (const StreamBits& bits : all) sum += bits;
  return sum;
}

// Finest first; the base, which no band holds, is on its own.
Json bands_json(const ModelFacts& facts, const std::vector<StreamBits>& bits) {
  Json bands = Json::array();
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    const BandFacts& band = facts.bands[b];
    bands.push_back({{"patches", band.patches},
                     {"contractions", band.contractions},
                     {"triangles_after", band.triangles_after},
                     {"surface_error", band.error.surface},
                     {"error", to_json(band.error)},
                     {"bits", streams_json(bits[b])}});
  }
  return bands;
}

}  // namespace

Json images_json(std::span<const ImageFile> images) {
  Json all = Json::array();
  for (const ImageFile& image : images) {
    all.push_back({{"name", image.name}, {"bytes", image.bytes->size()}});
  }
  return all;
}

Json images_json(std::span<const ImageEntry> images) {
  Json all = Json::array();
  for (const ImageEntry& image : images) {
    all.push_back({{"name", image.name}, {"bytes", image.range.bytes}});
  }
  return all;
}

std::pair<Vec3d, Vec3d> bounds_of(const Mesh& mesh) {
  Vec3d low = mesh.positions.front(), high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return {low, high};
}

Json mesh_facts(const Mesh& mesh) {
  const ShadingKinds kinds = classify_shading(mesh);
  const auto vertices = [&](VertexKind kind) { return std::ranges::count(kinds.of_vertex, kind); };
  const auto triangles = [&](TriangleKind kind) {
    return std::ranges::count(kinds.of_triangle, kind);
  };
  Json materials = Json::array();
  for (const Material& material : mesh.materials) materials.push_back(material.name);
  return {{"triangles", mesh.triangle_count()},
          {"vertices", mesh.vertex_count()},
          {"sn_vertices", vertices(VertexKind::SN)},
          {"nsn_vertices", vertices(VertexKind::NSN)},
          {"sn_triangles", triangles(TriangleKind::SN)},
          {"fn_triangles", triangles(TriangleKind::FN)},
          {"nsn_triangles", triangles(TriangleKind::NSN)},
          {"attributes", attributes_json(mesh)},
          {"materials", materials},
          {"parts", mesh.parts.size()},
          {"up", to_json(mesh.up)},
          {"bounds", bounds_json(mesh)}};
}

BitsPerVertex per_vertex(const StreamBits& bits, std::size_t vertices) {
  const double share = vertices > 0 ? 1 / static_cast<double>(vertices) : 0;
  BitsPerVertex result;
  result.connectivity = share * (bits.roots + bits.flags + bits.shapes + bits.labels);
  result.positions = share * bits.positions;
  result.attributes = share * (bits.categories + bits.values);
  result.total = result.connectivity + result.positions + result.attributes;
  return result;
}

BitsPerVertex whole_file_per_vertex(const ModelFile& file, const DecodedModel& model) {
  const std::size_t vertices = model.mesh.vertex_count();
  BitsPerVertex bits = per_vertex(sum_of(model.bits), vertices);
  const BlockFileHead& head = file.blocks().head();
  const double file_bits = 8.0 * static_cast<double>(head.file_bytes - head.images.bytes);
  bits.total = vertices > 0 ? file_bits / static_cast<double>(vertices) : 0;
  return bits;
}

Json file_facts(const ModelFile& file, const DecodedModel& model, const ProgressiveArrays& arrays) {
  const BlockFileHead& head = file.blocks().head();
  const std::uint64_t bytes = head.file_bytes;
  const LinearBytes linear = linear_bytes(arrays);
  Json json = mesh_facts(model.mesh);
  json.update(Json{{"version", head.version},
                   {"bytes", bytes},
                   {"bits_per_vertex", bits_json(whole_file_per_vertex(file, model))},
                   {"streams", streams_json(sum_of(model.bits))},
                   {"container_bytes", bytes - head.images.bytes - model.payload_bytes},
                   {"image_bytes", head.images.bytes},
                   {"bands", bands_json(file.blocks().facts(), model.bits)},
                   {"base_bits", streams_json(model.bits.back())},
                   {"blocks", file.blocks().block_count()},
                   {"depth", hierarchy_depth(arrays)},
                   {"linear_bytes",
                    {{"crease", linear.crease},
                     {"wedge", linear.wedge},
                     {"replicated", linear.replicated},
                     {"records", linear.records}}},
                   {"placement", arrays.placement == Placement::Optimal ? "optimal" : "endpoint"},
                   {"precision", arrays.grid.step}});
  return json;
}

Json head_facts(const ModelFile& file) {
  const ModelFacts& facts = file.blocks().facts();
  Json bands = Json::array();
  for (const BandFacts& band : facts.bands) {
    bands.push_back({{"patches", band.patches},
                     {"contractions", band.contractions},
                     {"triangles_after", band.triangles_after},
                     {"surface_error", band.error.surface},
                     {"error", to_json(band.error)}});
  }
  return {{"triangles", facts.triangle_count},
          {"vertices", facts.vertex_count},
          {"attributes", attributes_json(facts.layers)},
          {"version", file.blocks().head().version},
          {"bytes", file.blocks().head().file_bytes},
          {"image_bytes", file.blocks().head().images.bytes},
          {"bands", bands},
          {"blocks", file.blocks().block_count()},
          {"precision", facts.grid.step},
          {"up", to_json(facts.up)},
          {"bytes_read", file.bytes_to_open()}};
}

}  // namespace crease::cli

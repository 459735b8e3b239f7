#include "crease/import_arrays.h"

#include "io/formats.h"
#include "io/raw_mesh.h"
#include "mesh/finite_material.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

namespace crease {

namespace {

// Rows need not be aligned.
template <typename Number>
void copy_row(const Rows<Number>& rows, std::size_t row, std::size_t dimension, Number* to) {
  const std::size_t stride = rows.stride == 0 ? dimension * sizeof(Number) : rows.stride;
  std::memcpy(to, reinterpret_cast<const char*>(rows.first) + row * stride,
              dimension * sizeof(Number));
}

std::size_t row_count(const VertexArrays& arrays) {
  return std::visit([](const auto& rows) { return rows.count; }, arrays.positions);
}

bool is_dimension_of(AttributeRole role, std::uint32_t dimension) {
  switch (role) {
    case AttributeRole::Normal:
      return dimension == 3;
    case AttributeRole::TexCoord:
      return dimension == 2;
    case AttributeRole::Color:
      return dimension == 3 || dimension == 4;
    case AttributeRole::Other:
      return dimension >= 1 && dimension <= 4;
  }
  return false;
}

class ArrayReader {
 public:
  ArrayReader(const VertexArrays& arrays, std::string_view name)
      : arrays_(arrays), name_(name), vertex_count_(row_count(arrays)) {}

  Result<RawMesh> read() {
    raw_.report.format = "arrays";
    raw_.default_normals = arrays_.made_normals;
    raw_.up = arrays_.up;
    raw_.images = arrays_.images;
    if (!check_materials() || !read_positions() || !read_triangles() || !read_layers())
      return *failure_;
    if (!read_ids("material_of_triangle", arrays_.material_of_triangle, arrays_.materials.size(),
                  raw_.material_of_triangle) ||
        !read_ids("part_of_triangle", arrays_.part_of_triangle, arrays_.parts.size(),
                  raw_.part_of_triangle)) {
      return *failure_;
    }
    raw_.materials = arrays_.materials;
    raw_.parts = arrays_.parts;
    return std::move(raw_);
  }

 private:
  bool refuse(const std::string& reason) {
    failure_ = fail(Error::BadValue, name_ + ": " + reason);
    return false;
  }
  bool refuse_length(const std::string& array, std::size_t has, std::size_t needed,
                     const char* of) {
    return refuse(array + " has " + std::to_string(has) + " entries, not one for each of " +
                  std::to_string(needed) + " " + of);
  }
  // `allows_none`: kNone may stand where there is no value.
  bool check_indices(const std::string& array, std::span<const std::uint32_t> indices,
                     std::size_t count, bool allows_none = false) {
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] < count || (allows_none && indices[i] == kNone)) continue;
      return refuse(array + "[" + std::to_string(i) + "] is " + std::to_string(indices[i]) +
                    ", and there are " + std::to_string(count));
    }
    return true;
  }

  template <typename Number>
  bool check_rows(const std::string& array, const Rows<Number>& rows, std::size_t dimension) {
    const std::size_t row = dimension * sizeof(Number);
    if (rows.stride != 0 && rows.stride < row) {
      return refuse(array + " overlap: rows of " + std::to_string(row) + " bytes, each " +
                    std::to_string(rows.stride) + " after the last");
    }
    return rows.count == 0 || rows.first != nullptr ||
           refuse(array + " are nowhere: a null pointer");
  }

  bool check_materials() {
    for (const Material& material : arrays_.materials) {
      if (!is_finite(material)) {
        return refuse("material '" + material.name + "' has a number that is not finite");
      }
    }
    for (const ImageFile& image : arrays_.images) {
      if (image.bytes == nullptr) return refuse("image '" + image.name + "' has no bytes");
    }
    return true;
  }

  bool read_positions() {
    if (!std::visit([&](const auto& rows) { return check_rows("positions", rows, 3); },
                    arrays_.positions)) {
      return false;
    }
    raw_.positions.resize(vertex_count_);
    std::visit(
        [&](const auto& rows) {
          using Number = std::remove_const_t<std::remove_pointer_t<decltype(rows.first)>>;
          Number p[3];
          for (std::size_t v = 0; v < vertex_count_; ++v) {
            copy_row(rows, v, 3, p);
            raw_.positions[v] = {double(p[0]), double(p[1]), double(p[2])};
          }
        },
        arrays_.positions);
    for (std::size_t v = 0; v < vertex_count_; ++v) {
      if (is_position(raw_.positions[v])) continue;
      return refuse("positions[" + std::to_string(v) + "] is " + fault_of(raw_.positions[v]));
    }
    return true;
  }

  bool read_triangles() {
    if (!arrays_.indices.empty() && !arrays_.short_indices.empty()) {
      return refuse("both indices and short_indices");
    }
    std::vector<std::uint32_t> widened(arrays_.short_indices.begin(), arrays_.short_indices.end());
    const std::span<const std::uint32_t> indices = widened.empty() ? arrays_.indices : widened;
    const bool is_indexed = !indices.empty();
    const std::size_t corners = is_indexed ? indices.size() : vertex_count_;
    if (vertex_count_ >= kNone || corners >= kNone) {
      return refuse("more than 2^32 - 2 vertices or corners");
    }
    if (corners % 3 != 0) {
      return refuse(std::string(is_indexed ? "indices" : "positions, without indices,") +
                    " are three a triangle, and " + std::to_string(corners) + " are given");
    }
    if (!check_indices("indices", indices, vertex_count_)) return false;
    raw_.triangles.resize(corners / 3);
    for (std::size_t corner = 0; corner < corners; ++corner) {
      raw_.triangles[corner / 3][corner % 3] =
          is_indexed ? indices[corner] : static_cast<std::uint32_t>(corner);
    }
    return true;
  }

  bool read_layers() {
    bool has_normals = false;
    for (const ArrayLayer& layer : arrays_.layers) {
      if (layer.role == AttributeRole::Normal && std::exchange(has_normals, true)) {
        return refuse("two layers of normals, of which there can be one");
      }
      if (!read_layer(layer)) return false;
    }
    return true;
  }

  bool read_layer(const ArrayLayer& layer) {
    const std::string array = "layer '" + layer.name + "'";
    if (!is_dimension_of(layer.role, layer.dimension)) {
      return refuse(array + " has dimension " + std::to_string(layer.dimension) +
                    ", which its role does not allow");
    }
    if (layer.values.count > 0 && layer.bytes.count > 0) {
      return refuse(array + " has both values and bytes");
    }
    const std::size_t count = std::max(layer.values.count, layer.bytes.count);
    if (count >= kNone) return refuse(array + " has more than 2^32 - 2 values");
    const bool is_per_corner = !layer.of_corner.empty();
    const std::size_t corners = 3 * raw_.triangles.size();
    if (!is_per_corner && count != vertex_count_) {
      return refuse_length(array, count, vertex_count_, "vertices");
    }
    if (is_per_corner && layer.of_corner.size() != corners) {
      return refuse_length(array + ", of_corner", layer.of_corner.size(), corners, "corners");
    }
    if (!check_indices(array + ", of_corner", layer.of_corner, count, true)) {
      return false;
    }
    if (!check_rows(array + ": values", layer.values, layer.dimension) ||
        !check_rows(array + ": bytes", layer.bytes, layer.dimension)) {
      return false;
    }
    RawLayer raw;
    raw.name = layer.name;
    raw.role = layer.role;
    raw.interpolation =
        layer.role == AttributeRole::Normal ? Interpolation::Direction : layer.interpolation;
    raw.per = is_per_corner ? RawLayer::Per::Corner : RawLayer::Per::Vertex;
    raw.dimension = layer.dimension;
    raw.of_corner.assign(layer.of_corner.begin(), layer.of_corner.end());
    raw.values.resize(count * layer.dimension);
    for (std::size_t i = 0; i < layer.values.count; ++i) {
      copy_row(layer.values, i, layer.dimension, &raw.values[i * layer.dimension]);
    }
    for (std::size_t i = 0; i < layer.bytes.count; ++i) {
      std::uint8_t row[4];
      copy_row(layer.bytes, i, layer.dimension, row);
      std::transform(row, row + layer.dimension, &raw.values[i * layer.dimension],
                     [](std::uint8_t byte) { return float(byte) / 255; });
    }
    raw_.layers.push_back(std::move(raw));
    return true;
  }

  template <typename Id>
  bool read_ids(const std::string& array, std::span<const std::uint32_t> given, std::size_t count,
                std::vector<Id>& ids) {
    if (given.empty() && count > 0) ids.resize(raw_.triangles.size());
    if (given.empty()) return true;
    if (given.size() != raw_.triangles.size()) {
      return refuse_length(array, given.size(), raw_.triangles.size(), "triangles");
    }
    if (!check_indices(array, given, count)) return false;
    ids.reserve(given.size());
    for (std::uint32_t id : given) ids.push_back(Id{id});
    return true;
  }

  const VertexArrays& arrays_;
  std::string name_;
  std::size_t vertex_count_;
  RawMesh raw_;
  std::optional<Failure> failure_;
};

}  // namespace

Result<Imported> import_arrays(const VertexArrays& arrays, std::string_view name,
                               const ImportOptions& options) {
  Result<RawMesh> raw = ArrayReader(arrays, name).read();
  if (!raw.ok()) return raw.failure();
  return finish_import(*std::move(raw), options, std::string(name));
}

}  // namespace crease

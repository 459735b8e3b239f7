// A glTF file opened: its JSON and its buffers, and typed reading of accessors.
//
//   Result<GltfDocument> document = open_gltf(source);
//   GltfReader reader(source, *document);
//   Result<std::vector<float>> uv = reader.floats(accessor, 2, "meshes[0].primitives[0]...");
//
// Section numbers refer to the glTF 2.0 specification.
#pragma once

#include "crease/result.h"
#include "crease/vec.h"
#include "io/formats.h"
#include "io/json.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease {

struct GltfDocument {
  Json json;
  // The binary chunk of a GLB: what buffers[0] is if it has no uri.
  std::span<const std::byte> binary_chunk;
  // Added to every position: RTC_CENTER of a b3dm or CESIUM_RTC, turned to y-up.
  Vec3d center;
  std::string format;  // "glTF", "GLB" or "b3dm"
  std::vector<std::string> notes;
};

// Told by the first bytes. The document keeps views into the source's bytes.
Result<GltfDocument> open_gltf(const Source& source);

// NotSupported where the file cannot be read without an extension that is not read here.
Status check_required_extensions(const Source& source, const Json& json);

// The binary data of a "data:" URI. Fails if it is not base64.
Result<std::vector<std::byte>> decode_data_uri(const Source& source, const std::string& place,
                                               std::string_view uri);

// "%20" and the like replaced. A bad escape stays as it is.
std::string percent_decoded(std::string_view uri);

// A file beside the source, if it lies in the source's folder and nowhere else.
Result<std::vector<std::byte>> read_beside(const Source& source, const std::string& place,
                                           std::string_view uri);

// Reads accessors (5.1), sparse ones too. Buffers are decoded and loaded when first used. Every
// count is held against the bytes it needs before memory is taken.
class GltfReader {
 public:
  GltfReader(const Source& source, const GltfDocument& document)
      : source_(source), document_(document) {}

  // Components as floats, normalized integers divided out (3.6.2.2). Fails unless the accessor has
  // `min_components` to `max_components` a value. `place` is what refers to the accessor.
  struct Floats {
    std::vector<float> values;
    std::size_t components = 0;  // a value
    bool integers = false;       // stored as integers and not normalized
    Rounded rounded{};           // those of them
    bool is_worked_out = false;  // given as floats() would have made it of stored numbers
    std::size_t count() const { return components == 0 ? 0 : values.size() / components; }
  };
  Result<Floats> floats(const Json& accessor_index, std::size_t min_components,
                        std::size_t max_components, const std::string& place);

  Result<std::vector<std::uint32_t>> indices(const Json& accessor_index, const std::string& place);

  // All bytes of a bufferView; they stay as long as the reader.
  Result<std::span<const std::byte>> view_bytes(const Json& view_index, const std::string& place);

  // Of the buffers that were loaded so far.
  std::size_t buffer_bytes() const;

  // What there is to read: the file and, each once, the files beside it that are buffers. Loads
  // those; one that cannot be read counts nothing here and fails where it is used.
  std::size_t input_bytes();

  // From here on floats() and indices() give this for the accessor: what its primitive decoded.
  // Until the next forget_given().
  void give(std::size_t accessor, Floats values) { given_floats_[accessor] = std::move(values); }
  void give(std::size_t accessor, std::vector<std::uint32_t> indices) {
    given_indices_[accessor] = std::move(indices);
  }
  void forget_given() {
    given_floats_.clear();
    given_indices_.clear();
  }

  // Components a value of the accessor, 0 if there is no such accessor or it holds matrices.
  std::size_t components_of(const Json& accessor_index) const;

 private:
  // Where the values of an accessor lie.
  struct View {
    std::span<const std::byte> bytes;  // from the first value on; empty: all zero
    std::size_t stride = 0;
  };
  struct Layout {
    std::size_t count = 0, components = 0, component_type = 0, component_bytes = 0;
    bool normalized = false;
  };
  struct Buffer {
    bool loaded = false;
    std::vector<std::byte> decoded;  // out of a data URI
    std::span<const std::byte> bytes;
  };

  Result<Layout> layout_of(const Json& accessor, const std::string& place) const;
  Result<std::span<const std::byte>> file_beside(const std::string& place, const std::string& uri);
  Result<std::span<const std::byte>> buffer(std::size_t index, const std::string& place);
  // What `range` has of its buffer: a bufferView, or the extension that compresses one.
  Result<std::span<const std::byte>> bytes_of(const Json& range, const std::string& place);
  Result<Floats> large_integers(const Json& accessor, const Layout& layout,
                                const std::string& place);
  Result<Floats> given_as(const Floats& given, const Layout& layout,
                          const std::string& place) const;
  Result<View> view_of(const Json& owner, const std::string& place, std::size_t count,
                       std::size_t value_bytes);
  template <typename T>
  Result<std::vector<T>> read(const Json& accessor, const Layout& layout, const std::string& place);

  const Source& source_;
  const GltfDocument& document_;
  std::vector<Buffer> buffers_;
  std::map<std::string, std::vector<std::byte>> files_;  // by uri
  std::optional<std::size_t> input_bytes_;
  std::map<std::size_t, std::vector<std::byte>> decoded_views_;  // those that are compressed
  std::map<std::size_t, Floats> given_floats_;
  std::map<std::size_t, std::vector<std::uint32_t>> given_indices_;
};

}  // namespace crease

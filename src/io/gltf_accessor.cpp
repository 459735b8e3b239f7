#include "io/gltf_compression.h"
#include "io/gltf_document.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace crease {
namespace {

// 3.6.2.2: component types.
enum ComponentType : std::size_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

std::size_t bytes_of_component(std::size_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

std::size_t components_of_type(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;
}

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

template <typename Stored>
Stored load(const std::byte* at) {
  Stored value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

float normalized_component(double value, double largest) {
  return static_cast<float>(std::max(value / largest, -1.0));
}

double largest_of(std::size_t type) {
  switch (type) {
    case kByte:
      return 127;
    case kUnsignedByte:
      return 255;
    case kShort:
      return 32767;
    case kUnsignedShort:
      return 65535;
    default:
      return 4294967295.0;
  }
}

// One component as a float (3.6.2.2: c / 255, max(c / 127, -1) and so on) or as an index.
template <typename T>
T component(const std::byte* at, std::size_t type, bool normalized) {
  if constexpr (std::is_same_v<T, std::uint32_t>) {
    switch (type) {
      case kUnsignedByte:
        return load<std::uint8_t>(at);
      case kUnsignedShort:
        return load<std::uint16_t>(at);
      default:
        return load<std::uint32_t>(at);
    }
  } else {
    switch (type) {
      case kByte: {
        const auto value = load<std::int8_t>(at);
        return normalized ? normalized_component(value, largest_of(type)) : float(value);
      }
      case kUnsignedByte: {
        const auto value = load<std::uint8_t>(at);
        return normalized ? normalized_component(value, largest_of(type)) : float(value);
      }
      case kShort: {
        const auto value = load<std::int16_t>(at);
        return normalized ? normalized_component(value, largest_of(type)) : float(value);
      }
      case kUnsignedShort: {
        const auto value = load<std::uint16_t>(at);
        return normalized ? normalized_component(value, largest_of(type)) : float(value);
      }
      case kUnsignedInt: {
        const auto value = load<std::uint32_t>(at);
        return normalized ? normalized_component(value, largest_of(type)) : float(value);
      }
      default:
        return load<float>(at);
    }
  }
}

}  // namespace

std::size_t GltfReader::components_of(const Json& accessor_index) const {
  const auto index = as_index(accessor_index);
  if (!index) return 0;
  const std::size_t components =
      components_of_type(as_text(at(at(at(document_.json, "accessors"), *index), "type")));
  return components <= 4 ? components : 0;
}

Result<GltfReader::Layout> GltfReader::layout_of(const Json& accessor,
                                                 const std::string& place) const {
  Layout layout;
  const auto count = as_index(at(accessor, "count"));
  const auto type = as_index(at(accessor, "componentType"));
  layout.components = components_of_type(as_text(at(accessor, "type")));
  layout.component_type = type.value_or(0);
  layout.component_bytes = bytes_of_component(layout.component_type);
  layout.normalized = as_bool(at(accessor, "normalized"));
  if (!count || layout.components == 0 || layout.component_bytes == 0) {
    return fail_at_place(Error::BadFormat, source_, place,
                         "accessor without a usable count, type or componentType");
  }
  layout.count = *count;
  return layout;
}

Result<std::span<const std::byte>> GltfReader::buffer(std::size_t index, const std::string& place) {
  const Json& buffers = at(document_.json, "buffers");
  if (index >= size_of(buffers)) {
    return fail_at_place(
        Error::BadValue, source_, place,
        "buffer " + std::to_string(index) + " of " + std::to_string(size_of(buffers)));
  }
  buffers_.resize(size_of(buffers));
  Buffer& entry = buffers_[index];
  if (entry.loaded) return entry.bytes;
  const std::string here = place_of("buffers", index);
  const Json& json = buffers[index];
  const auto length = as_index(at(json, "byteLength"));
  if (!length) return fail_at_place(Error::BadFormat, source_, here, "no byteLength");
  const std::string* uri = at(json, "uri").get_ptr<const std::string*>();
  if (uri == nullptr) {
    if (index != 0) return fail_at_place(Error::BadFormat, source_, here, "no uri");
    entry.bytes = document_.binary_chunk;
  } else if (uri->starts_with("data:")) {
    Result<std::vector<std::byte>> bytes = decode_data_uri(source_, here + ".uri", *uri);
    if (!bytes.ok()) return bytes.failure();
    entry.decoded = *std::move(bytes);
    entry.bytes = entry.decoded;
  } else {
    const Result<std::span<const std::byte>> bytes = file_beside(here + ".uri", *uri);
    if (!bytes.ok()) return bytes.failure();
    entry.bytes = *bytes;
  }
  if (entry.bytes.size() < *length) {
    return fail_at_place(Error::Truncated, source_, here,
                         "byteLength is " + std::to_string(*length) + ", there are " +
                             std::to_string(entry.bytes.size()));
  }
  entry.bytes = entry.bytes.first(*length);
  entry.loaded = true;
  return entry.bytes;
}

// They stay as long as the reader.
Result<std::span<const std::byte>> GltfReader::file_beside(const std::string& place,
                                                           const std::string& uri) {
  const auto known = files_.find(uri);
  if (known != files_.end()) return std::span<const std::byte>(known->second);
  Result<std::vector<std::byte>> bytes = read_beside(source_, place, uri);
  if (!bytes.ok()) return bytes.failure();
  return std::span<const std::byte>(files_[uri] = *std::move(bytes));
}

std::size_t GltfReader::input_bytes() {
  if (input_bytes_) return *input_bytes_;
  const Json& buffers = at(document_.json, "buffers");
  for (std::size_t i = 0; i < size_of(buffers); ++i) {
    const std::string uri = as_text(at(buffers[i], "uri"));
    if (!uri.empty() && !uri.starts_with("data:")) {
      static_cast<void>(file_beside(place_of("buffers", i) + ".uri", uri));
    }
  }
  input_bytes_ = source_.bytes.size();
  for (const auto& [uri, bytes] : files_) *input_bytes_ += bytes.size();
  return *input_bytes_;
}

std::size_t GltfReader::buffer_bytes() const {
  std::size_t bytes = 0;
  for (const Buffer& entry : buffers_) bytes += entry.bytes.size();
  return bytes;
}

Result<std::span<const std::byte>> GltfReader::view_bytes(const Json& view_index,
                                                          const std::string& place) {
  const auto index = as_index(view_index);
  const Json& views = at(document_.json, "bufferViews");
  if (!index || *index >= size_of(views)) {
    return fail_at_place(Error::BadValue, source_, place, "no such bufferView");
  }
  const Json& json = views[*index];
  const std::string here = place_of("bufferViews", *index);
  const Json& compressed = meshopt_of(json);
  if (!compressed.is_object()) return bytes_of(json, here);
  const auto known = decoded_views_.find(*index);
  if (known != decoded_views_.end()) return std::span<const std::byte>(known->second);
  const Result<std::span<const std::byte>> encoded = bytes_of(compressed, here);
  if (!encoded.ok()) return encoded.failure();
  Result<std::vector<std::byte>> decoded = decode_meshopt(source_, here, compressed, *encoded);
  if (!decoded.ok()) return decoded.failure();
  return std::span<const std::byte>(decoded_views_[*index] = *std::move(decoded));
}

Result<std::span<const std::byte>> GltfReader::bytes_of(const Json& range,
                                                        const std::string& place) {
  Result<std::span<const std::byte>> bytes =
      buffer(as_index(at(range, "buffer")).value_or(std::size_t(-1)), place + ".buffer");
  if (!bytes.ok()) return bytes.failure();
  const std::size_t offset = as_index(at(range, "byteOffset")).value_or(0);
  const std::size_t length = as_index(at(range, "byteLength")).value_or(0);
  if (offset > bytes->size() || length > bytes->size() - offset) {
    return fail_at_place(Error::BadValue, source_, place,
                         "reaches to byte " + std::to_string(offset) + " + " +
                             std::to_string(length) + " of a buffer of " +
                             std::to_string(bytes->size()));
  }
  return bytes->subspan(offset, length);
}

// `owner` has bufferView and byteOffset: an accessor, or one of the two parts of `sparse`.
Result<GltfReader::View> GltfReader::view_of(const Json& owner, const std::string& place,
                                             std::size_t count, std::size_t value_bytes) {
  const Json& index = at(owner, "bufferView");
  const Result<std::span<const std::byte>> bytes = view_bytes(index, place);
  if (!bytes.ok()) return bytes.failure();
  const Json& json = at(at(document_.json, "bufferViews"), *as_index(index));
  const std::string here = place_of("bufferViews", *as_index(index));
  View view;
  const Json& compressed = meshopt_of(json);
  const Json& layout = compressed.is_object() ? compressed : json;
  view.stride = as_index(at(layout, "byteStride")).value_or(value_bytes);
  if (view.stride == 0) view.stride = value_bytes;  // as exporters of Unity wrote it
  const std::size_t offset = as_index(at(owner, "byteOffset")).value_or(0);
  if (view.stride < value_bytes) {
    return fail_at_place(Error::BadValue, source_, here + ".byteStride",
                         std::to_string(view.stride) + " is less than a value's " +
                             std::to_string(value_bytes) + " bytes");
  }
  // offset + stride * (count - 1) + value_bytes <= view_length, without overflow.
  const std::size_t view_length = bytes->size();
  if (count > 0 && (offset > view_length || view_length - offset < value_bytes ||
                    (count - 1) > (view_length - offset - value_bytes) / view.stride)) {
    return fail_at_place(Error::BadValue, source_, place,
                         std::to_string(count) + " values at byte " + std::to_string(offset) +
                             " do not fit into " + here + " of " + std::to_string(view_length) +
                             " bytes");
  }
  if (count > 0) view.bytes = bytes->subspan(offset);
  return view;
}

template <typename T>
Result<std::vector<T>> GltfReader::read(const Json& accessor, const Layout& layout,
                                        const std::string& place) {
  const std::size_t value_bytes = layout.components * layout.component_bytes;
  const auto decode = [&](const std::byte* from, T* to) {
    for (std::size_t k = 0; k < layout.components; ++k) {
      to[k] =
          component<T>(from + k * layout.component_bytes, layout.component_type, layout.normalized);
    }
  };
  std::vector<T> values;
  if (at(accessor, "bufferView").is_number()) {
    Result<View> view = view_of(accessor, place, layout.count, value_bytes);
    if (!view.ok()) return view.failure();
    values.resize(layout.count * layout.components);
    for (std::size_t i = 0; i < layout.count; ++i) {
      decode(view->bytes.data() + i * view->stride, &values[i * layout.components]);
    }
  } else if (layout.count > 1024 + 64 * input_bytes()) {
    // Zeros need no bytes, so only this keeps them from asking for any memory.
    return fail_at_place(Error::OverLimit, source_, place,
                         std::to_string(layout.count) + " values without data");
  } else {
    values.resize(layout.count * layout.components);
  }

  const Json& sparse = at(accessor, "sparse");
  if (!sparse.is_object()) return values;
  const std::string sparse_place = place + ".sparse";
  const std::size_t sparse_count = as_index(at(sparse, "count")).value_or(0);
  const Json& sparse_indices = at(sparse, "indices");
  const std::size_t index_type = as_index(at(sparse_indices, "componentType")).value_or(0);
  const std::size_t index_bytes = bytes_of_component(index_type);
  if (index_bytes == 0 || index_type == kFloat) {
    return fail_at_place(Error::BadFormat, source_, sparse_place + ".indices.componentType",
                         "not an index type");
  }
  Result<View> where =
      view_of(sparse_indices, sparse_place + ".indices", sparse_count, index_bytes);
  if (!where.ok()) return where.failure();
  Result<View> what =
      view_of(at(sparse, "values"), sparse_place + ".values", sparse_count, value_bytes);
  if (!what.ok()) return what.failure();
  for (std::size_t i = 0; i < sparse_count; ++i) {
    const std::size_t target =
        component<std::uint32_t>(where->bytes.data() + i * where->stride, index_type, false);
    if (target >= layout.count) {
      return fail_at_place(Error::BadValue, source_, sparse_place + place_of(".indices", i),
                           std::to_string(target) + " of " + std::to_string(layout.count));
    }
    decode(what->bytes.data() + i * what->stride, &values[target * layout.components]);
  }
  return values;
}

// Stored numbers as what the accessor says they are, however many it says.
Result<GltfReader::Floats> GltfReader::given_as(const Floats& given, const Layout& layout,
                                                const std::string& place) const {
  if (given.components != layout.components) {
    return fail_at_place(Error::BadValue, source_, place,
                         "decoded are " + std::to_string(given.count()) + " values of " +
                             std::to_string(given.components) + " components");
  }
  Floats floats = given;
  if (given.is_worked_out) return floats;
  floats.integers = layout.component_type != kFloat && !layout.normalized;
  if (!layout.normalized) return floats;
  for (float& x : floats.values)
    x = normalized_component(double(x), largest_of(layout.component_type));
  return floats;
}

// Of which some may be no floats.
Result<GltfReader::Floats> GltfReader::large_integers(const Json& accessor, const Layout& layout,
                                                      const std::string& place) {
  const Result<std::vector<std::uint32_t>> values = read<std::uint32_t>(accessor, layout, place);
  if (!values.ok()) return values.failure();
  Floats floats{{}, layout.components, true};
  floats.values.reserve(values->size());
  for (const std::uint32_t x : *values) floats.values.push_back(floats.rounded.to_float(x));
  return floats;
}

Result<GltfReader::Floats> GltfReader::floats(const Json& accessor_index,
                                              std::size_t min_components,
                                              std::size_t max_components,
                                              const std::string& place) {
  const auto index = as_index(accessor_index);
  const Json& accessors = at(document_.json, "accessors");
  if (!index || *index >= size_of(accessors)) {
    return fail_at_place(Error::BadValue, source_, place, "no such accessor");
  }
  const std::string here = place + " (accessors[" + std::to_string(*index) + "])";
  Result<Layout> layout = layout_of(accessors[*index], here);
  if (!layout.ok()) return layout.failure();
  if (layout->components < min_components || layout->components > max_components) {
    return fail_at_place(Error::BadFormat, source_, here,
                         as_text(at(accessors[*index], "type")) + " cannot be used here");
  }
  if (const auto given = given_floats_.find(*index); given != given_floats_.end()) {
    return given_as(given->second, *layout, here);
  }
  if (layout->component_type == kUnsignedInt && !layout->normalized) {
    return large_integers(accessors[*index], *layout, here);
  }
  Result<std::vector<float>> values = read<float>(accessors[*index], *layout, here);
  if (!values.ok()) return values.failure();
  return Floats{*std::move(values), layout->components,
                layout->component_type != kFloat && !layout->normalized};
}

Result<std::vector<std::uint32_t>> GltfReader::indices(const Json& accessor_index,
                                                       const std::string& place) {
  const auto index = as_index(accessor_index);
  const Json& accessors = at(document_.json, "accessors");
  if (!index || *index >= size_of(accessors)) {
    return fail_at_place(Error::BadValue, source_, place, "no such accessor");
  }
  const std::string here = place + " (accessors[" + std::to_string(*index) + "])";
  Result<Layout> layout = layout_of(accessors[*index], here);
  if (!layout.ok()) return layout.failure();
  const std::size_t type = layout->component_type;
  if (layout->components != 1 ||
      (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt)) {
    return fail_at_place(Error::BadFormat, source_, here, "not an accessor of indices");
  }
  if (const auto given = given_indices_.find(*index); given != given_indices_.end()) {
    return given->second;
  }
  return read<std::uint32_t>(accessors[*index], *layout, here);
}

}  // namespace crease

#include "io/gltf_instancing.h"

#include <algorithm>
#include <array>
#include <optional>

namespace crease {

Result<std::vector<Transform>> read_instancing(const Source& source, const Json& extension,
                                               GltfReader& reader, std::size_t most,
                                               const std::string& place,
                                               std::map<std::string, std::size_t>& ignored) {
  struct Attribute {
    const char* name;
    std::size_t components;
    std::array<double, 4> otherwise;
    GltfReader::Floats floats{};
  };
  std::array<Attribute, 3> attributes{{{"TRANSLATION", 3, {0, 0, 0, 0}},
                                       {"ROTATION", 4, {0, 0, 0, 1}},
                                       {"SCALE", 3, {1, 1, 1, 0}}}};
  const Json& stored = at(extension, "attributes");
  std::optional<std::size_t> count;
  for (Attribute& attribute : attributes) {
    const Json& accessor = at(stored, attribute.name);
    if (accessor.is_null()) continue;
    const std::string here = place + ".attributes." + attribute.name;
    auto read = reader.floats(accessor, attribute.components, attribute.components, here);
    if (!read.ok()) return read.failure();
    attribute.floats = *std::move(read);
    if (count.value_or(attribute.floats.count()) != attribute.floats.count()) {
      return fail_at_place(Error::BadValue, source, here, "not a value for every instance");
    }
    count = attribute.floats.count();
  }
  if (!count) {
    return fail_at_place(Error::NotSupported, source, place + ".attributes",
                         "no TRANSLATION, ROTATION or SCALE: how many instances are there?");
  }
  if (*count > most) {
    return fail_at_place(Error::OverLimit, source, place,
                         "instances multiply the file beyond reason");
  }
  for (auto it = stored.begin(); it != stored.end(); ++it) {
    const auto is_it = [&](const Attribute& attribute) { return it.key() == attribute.name; };
    if (std::none_of(attributes.begin(), attributes.end(), is_it)) ++ignored[it.key()];
  }
  std::vector<Transform> transforms;
  for (std::size_t i = 0; i < *count; ++i) {
    std::array<std::array<double, 4>, 3> trs;
    for (std::size_t a = 0; a < 3; ++a) {
      const Attribute& attribute = attributes[a];
      trs[a] = attribute.otherwise;
      for (std::size_t k = 0; k < attribute.components && !attribute.floats.values.empty(); ++k) {
        trs[a][k] = double(attribute.floats.values[i * attribute.components + k]);
      }
    }
    transforms.push_back(transform_of_trs(trs[0].data(), trs[1].data(), trs[2].data()));
  }
  return transforms;
}

}  // namespace crease

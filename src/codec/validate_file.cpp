#include "codec/decode_file.h"
#include "hierarchy/linear_state.h"

#include <cstring>

namespace crease {

namespace {

bool same_bits(const std::vector<float>& a, const float* b) {
  return a.empty() || std::memcmp(a.data(), b, a.size() * sizeof(float)) == 0;
}

// Every contraction forwards and backwards ends where it began.
void check_round_trip(const ProgressiveArrays& arrays, std::vector<std::string>& wrong) {
  LinearState state(arrays);
  NoMarks marks;
  while (state.applied() < arrays.contractions.count()) state.apply(marks);
  while (state.applied() > 0) state.undo(marks);
  const auto differs = [&wrong](const std::string& what) {
    wrong.push_back(what + " differ after all contractions forwards and backwards");
  };
  if (state.positions != arrays.positions) differs("positions");
  if (state.indices != arrays.indices) differs("triangle indices");
  if (state.nsn_normals != arrays.nsn_normals) differs("normal indices");
  if (!state.own_normals.empty() && std::memcmp(state.own_normals.data(), arrays.normals.data(),
                                                state.own_normals.size() * sizeof(Vec3f)) != 0) {
    differs("normals");
  }
  for (std::size_t l = 0; l < arrays.layers.size(); ++l) {
    if (state.layers[l].indices != arrays.layers[l].indices ||
        !same_bits(state.layers[l].own, arrays.layers[l].values.data())) {
      differs("values of layer '" + arrays.layers[l].name + "'");
    }
  }
}

}  // namespace

std::vector<std::string> validate_crease(std::span<const std::byte> bytes) {
  std::vector<std::string> wrong;
  const Result<SectionTable> table = decode_section_table(bytes, {}, Checksums::Verify);
  if (!table.ok()) return {table.failure().message};
  for (const SectionEntry& entry : table->entries) {
    if (std::string failure = checksum_failure(bytes, entry); !failure.empty()) {
      wrong.push_back(std::move(failure));
    }
  }
  const Result<CreaseFile> file = decode_file(bytes, {}, Checksums::Ignore);
  if (!file.ok()) {
    wrong.push_back(file.failure().message);
    return wrong;
  }
  check_round_trip(*file->arrays, wrong);
  return wrong;
}

}  // namespace crease

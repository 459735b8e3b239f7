#include "mesh/weld.h"

#include "crease/ids.h"
#include "mesh/mix.h"

#include <bit>
#include <random>

namespace crease {

namespace {

// -0 and +0 are one value; x + 0 is x for every other x.
std::uint64_t bits_of(double x) {
  return std::bit_cast<std::uint64_t>(x + 0.0);
}
std::uint64_t bits_of(float x) {
  return std::bit_cast<std::uint32_t>(x + 0.0f);
}

// Another one in every process: who writes a file cannot know which values share a slot. Which
// values are equal, and their order, does not depend on it.
std::uint64_t seed() {
  static const std::uint64_t kSeed = [] {
    std::random_device device;
    return (std::uint64_t(device()) << 32) ^ device();
  }();
  return kSeed;
}

template <typename Row>  // Row: row(i, k) gives component k of value i
Weld weld_rows(std::size_t count, std::size_t width, Row row) {
  Weld weld;
  weld.new_of_old.reserve(count);
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * count + 1), kNone);  // indices into first_old
  const std::size_t mask = slots.size() - 1;
  const std::uint64_t start = seed();
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t hash = start;
    for (std::size_t k = 0; k < width; ++k) hash = mix(hash ^ bits_of(row(i, k)));
    std::size_t slot = hash & mask;
    while (true) {
      if (slots[slot] == kNone) {
        slots[slot] = static_cast<std::uint32_t>(weld.first_old.size());
        weld.first_old.push_back(static_cast<std::uint32_t>(i));
        break;
      }
      const std::size_t other = weld.first_old[slots[slot]];
      bool equal = true;
      for (std::size_t k = 0; k < width && equal; ++k) {
        equal = bits_of(row(i, k)) == bits_of(row(other, k));
      }
      if (equal) break;
      slot = (slot + 1) & mask;
    }
    weld.new_of_old.push_back(slots[slot]);
  }
  return weld;
}

}  // namespace

Weld weld_positions(std::span<const Vec3d> positions) {
  return weld_rows(positions.size(), 3,
                   [&](std::size_t i, std::size_t k) { return positions[i][static_cast<int>(k)]; });
}

Weld weld_values(std::span<const float> values, std::uint32_t dimension) {
  return weld_rows(values.size() / dimension, dimension,
                   [&](std::size_t i, std::size_t k) { return values[i * dimension + k]; });
}

}  // namespace crease

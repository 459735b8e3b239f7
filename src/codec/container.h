// The tables of docs/format.md as constants.
#pragma once

#include "crease/block_file.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace crease::format {

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'C', 'R', 'E', 'A', 'S', 'E', '\n'};
// Layout 7 is layout 6 with images; layout 8 has materials with holes or two sides, and perhaps
// images; layout 9 is layout 8 with materials that are blended. A file is of the least one that has
// all it needs. Versions 6 to 9 are these, versions 10 to 13 the same with blocks that learn at
// other rates (learning_rates.h); files are written in those.
inline constexpr std::uint16_t kContainerLayout = 6, kLayoutWithImages = 7, kLayoutWithSurfaces = 8,
                               kLayoutWithBlending = 9;
inline constexpr std::uint16_t kVersionWithRates = 10, kNewestVersion = 13;
constexpr std::uint16_t layout_of(std::uint16_t version) {
  constexpr std::uint16_t kMoved = kVersionWithRates - kContainerLayout;
  return version < kVersionWithRates ? version : static_cast<std::uint16_t>(version - kMoved);
}
constexpr std::uint16_t version_of(std::uint16_t layout) {
  return static_cast<std::uint16_t>(layout + (kVersionWithRates - kContainerLayout));
}
static_assert(layout_of(kNewestVersion) == kLayoutWithBlending);
// Of AttributeCoding::Lattice. Values of the code that the enumeration has are coded as no program
// reads any more.
inline constexpr std::uint8_t kLatticeCode = 4;

// The head; its first 32 bytes are read before any other.
inline constexpr std::uint32_t kMaxHeadBytes = 65'536;
inline constexpr std::uint32_t kHeadStartBytes = 32;
inline constexpr std::uint32_t kHeadChecksumOffset = 24;
inline constexpr std::uint32_t kFixedHeadBytes = 144;
inline constexpr std::uint32_t kImageHeadBytes = 24;  // behind those, with images
inline constexpr std::uint32_t kLayerBytes = 12;      // beside the name's bytes
inline constexpr std::uint32_t kPageReferenceBytes = 12;
inline constexpr std::uint8_t kMaxGridBits = 31;
inline constexpr double kMostStepsToOrigin = 1125899906842624;  // 2^50

// Names.
inline constexpr std::uint32_t kMinMaterialBytes = 24;         // beside the next ones
inline constexpr std::uint8_t kDoubleSided = 1, kBlended = 2;  // flags of a material
inline constexpr std::uint32_t kImageEntryBytes = 20;          // beside the name's bytes

// A page of the directory.
inline constexpr std::uint32_t kMaxPageBytes = 4u << 20;
inline constexpr std::uint32_t kPageHeadBytes = 16;
inline constexpr std::uint32_t kPayloadChecksumBytes = 4;
inline constexpr std::uint32_t kMaxPageDependencies = 1u << 20;

constexpr std::uint32_t page_count(std::uint32_t blocks) {
  return blocks / kBlocksPerPage + (blocks % kBlocksPerPage == 0 ? 0 : 1);
}
constexpr std::uint32_t blocks_of_page(std::uint32_t blocks, std::uint32_t page) {
  const std::uint32_t before = page * kBlocksPerPage;
  return blocks - before < kBlocksPerPage ? blocks - before : kBlocksPerPage;
}
// Of the page, before its entries.
constexpr std::uint32_t fixed_page_bytes(std::uint32_t blocks) {
  return kPageHeadBytes + kPayloadChecksumBytes * blocks;
}

// Errors of blocks: the upper half of an f32 without its sign.
inline constexpr std::uint16_t kMaxErrorCode = 0xfeff;

constexpr float error_of_code(std::uint16_t code) {
  return std::bit_cast<float>(std::uint32_t(code) << 15);
}
// The least code whose error is not below this one, which is 0 to error_of_code(kMaxErrorCode).
constexpr std::uint16_t code_of_error(float error) {
  const float positive = error + 0.0f;  // -0 is no less than 0, but its bits are
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(positive) + 0x7fffu) >> 15);
}

// Spheres of blocks: a radius of at most eight digits and zeros behind them, as many as each
// coordinate of the centre has at least.
inline constexpr std::uint32_t kRadiusSteps = 128;  // of those with eight digits, up to twice it
inline constexpr int kMaxSphereShift = 24;
inline constexpr std::uint32_t kMaxRadiusCode =
    kMaxSphereShift * kRadiusSteps + 2 * kRadiusSteps - 1;

constexpr int sphere_shift(std::uint32_t radius) {
  const int digits = std::bit_width(radius);
  return digits > 8 ? digits - 8 : 0;
}
// Of a rounded one. Codes ascend with their radii, and none is left out.
constexpr std::uint32_t code_of_radius(std::uint32_t radius) {
  const int shift = sphere_shift(radius);
  return static_cast<std::uint32_t>(shift) * kRadiusSteps + (radius >> shift);
}
constexpr std::uint32_t radius_of_code(std::uint32_t code) {
  const std::uint32_t shift = code < 2 * kRadiusSteps ? 0 : code / kRadiusSteps - 1;
  return (code - shift * kRadiusSteps) << shift;
}

}  // namespace crease::format

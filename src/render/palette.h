// The colours of pictures. Linear RGB unless a name says srgb.
#pragma once

#include "base/srgb.h"
#include "crease/mesh.h"
#include "crease/shading.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

using Color = std::array<float, 3>;
using ColorSrgb = std::array<std::uint8_t, 3>;

Color linear_from_srgb(const ColorSrgb& encoded);

inline constexpr ColorSrgb kBackgroundTop{250, 251, 252}, kBackgroundBottom{218, 224, 231};
inline constexpr ColorSrgb kTextColor{38, 43, 51}, kPageColor{255, 255, 255};
inline constexpr ColorSrgb kSeparatorColor{196, 202, 210}, kDividerColor{120, 128, 140};
inline constexpr ColorSrgb kFrustumColor{20, 24, 30};
inline constexpr ColorSrgb kCreaseColor{26, 30, 38}, kBorderColor{214, 72, 20};

inline constexpr ColorSrgb kDefaultSurface{224, 217, 207};  // warm light grey

// Apart in hue and lightness for all common kinds of colour vision.
ColorSrgb kind_color(TriangleKind kind);

// 0: full resolution, green-blue; 1: base, dark violet.
inline constexpr std::size_t kLevelStopCount = 5;
extern const std::array<ColorSrgb, kLevelStopCount> kLevelStops;
ColorSrgb level_color(float share);

// 0: blue, 1: red.
inline constexpr std::size_t kErrorStopCount = 7;
extern const std::array<ColorSrgb, kErrorStopCount> kErrorStops;
ColorSrgb error_color(float share);

// All of them white, without textures.
bool have_names_only(std::span<const Material> materials);
// What to draw each material in. Those that have names only get colours by the names, in the words
// of cities (roof, wall, ground, glass, ...), then by order.
std::vector<std::array<float, 4>> material_colors(std::span<const Material> materials);

}  // namespace crease

// How fast a block's mixtures learn, by the version of the file.
#pragma once

namespace crease::codec {

// Steep slopes over sizes that vary much, as on a fine grid, run away from what is there, so they
// learn slowly; and scales learn quickly at first, since what a block starts from is of grids of 14
// bits.
struct LearningRates {
  float place_slopes = 0.004f, direction_slopes = 0.001f;
  float mean_sizes = 0.04f;
  float first_scales = 1;  // beside the rate of later ones
};

// Of files up to version 9.
inline constexpr LearningRates kRatesBefore{
    .place_slopes = 0.015f, .direction_slopes = 0.015f, .mean_sizes = 0.02f, .first_scales = 0};

}  // namespace crease::codec

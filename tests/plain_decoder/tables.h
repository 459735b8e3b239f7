// docs/format-models.md, table by table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace plain {

// "Squash".
inline constexpr std::array<std::int32_t, 33> kSquash{
    1,    2,    3,    6,    10,   16,   27,   45,   73,   120,  194,
    310,  488,  747,  1101, 1546, 2047, 2549, 2994, 3348, 3607, 3785,
    3901, 3975, 4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094};

// "Pairs of a closed fan".
inline constexpr float kPairRate = 0.015f;  // of all rates
inline constexpr std::array<float, 6> kBothWeights{-1.548f, 0.317f, 0.683f,
                                                   0.438f,  1.564f, -0.647f};
inline constexpr std::array<float, 6> kBothRates{5.9f, 24, 9.5f, 8.5f, 12.7f, 7.5f};
inline constexpr std::array<float, 3> kEachWeights{-0.417f, 0.436f, -0.333f};
inline constexpr std::array<float, 3> kEachRates{2.2f, 1.7f, 1.5f};
// Of 3, 4, ... triangles at a vertex.
inline constexpr std::array<float, 8> kTrianglesWeights{0.737f,  0.335f,  0.196f,  -0.299f,
                                                        -0.169f, -0.343f, -0.081f, 0.805f};
inline constexpr std::array<float, 8> kTrianglesRates{12, 5, 2.7f, 2.2f, 3.5f, 6.9f, 17.8f, 12.9f};
// Of 1, 2, ... old triangles of a child.
inline constexpr std::array<float, 7> kChildWeights{-1.507f, 0.416f, 1.112f, 1.252f,
                                                    0.731f,  0.405f, 0};
inline constexpr std::array<float, 7> kChildRates{4.5f, 4.4f, 3.5f, 3.5f, 4.7f, 5.8f, 6};

// "Places".
struct PlaceStart {
  std::array<float, 8> k;                       // own, other, thirds, sibling; then along the
                                                // normal
  std::array<std::array<float, 8>, 6> weights;  // of 3, 4, ... triangles
  std::size_t scales;                           // in kPlaceScales
};
inline constexpr std::array<PlaceStart, 5> kPlaces{{
    // one
    {{0.785f, -0.109f, -0.253f, 0, -0.488f, 0.123f, 0.045f, 0},
     {{{0.417f, 0.360f, 0.021f, 0.071f, 0.047f, 0.001f, 0.001f, 0.116f},
       {0.551f, 0.102f, 0.226f, 0.021f, 0.026f, 0.023f, 0.012f, 0.043f},
       {0.760f, 0.072f, 0.072f, 0.016f, 0.020f, 0.014f, 0.020f, 0.028f},
       {0.686f, 0.049f, 0.162f, 0.016f, 0.017f, 0.026f, 0.026f, 0.021f},
       {0.704f, 0.150f, 0.041f, 0.014f, 0.021f, 0.011f, 0.010f, 0.051f},
       {0.520f, 0.187f, 0.044f, 0.034f, 0.035f, 0.024f, 0.025f, 0.154f}}},
     0},
    // second of both
    {{0.400f, -0.146f, -0.045f, 0, -0.124f, 0.234f, -0.206f, 0},
     {{{0.354f, 0.321f, 0.007f, 0.001f, 0.001f, 0.016f, 0.016f, 0.315f},
       {0.546f, 0.217f, 0.097f, 0.001f, 0.001f, 0.005f, 0.007f, 0.128f},
       {0.743f, 0.124f, 0.032f, 0.001f, 0.001f, 0.002f, 0.002f, 0.097f},
       {0.816f, 0.036f, 0.056f, 0.001f, 0.001f, 0.002f, 0.002f, 0.087f},
       {0.673f, 0.106f, 0.013f, 0.001f, 0.001f, 0.001f, 0.001f, 0.208f},
       {0.457f, 0.123f, 0.010f, 0.001f, 0.001f, 0.001f, 0.001f, 0.413f}}},
     1},
    // first of both
    {{0.339f, -0.111f, -0.026f, -0.150f, -0.094f, 0.337f, -0.303f, -0.170f},
     {{{0.212f, 0.363f, 0.008f, 0.002f, 0.001f, 0.012f, 0.008f, 0.415f},
       {0.490f, 0.235f, 0.102f, 0.001f, 0.001f, 0.004f, 0.003f, 0.169f},
       {0.718f, 0.150f, 0.032f, 0.001f, 0.001f, 0.005f, 0.002f, 0.094f},
       {0.821f, 0.028f, 0.059f, 0.001f, 0.001f, 0.001f, 0.002f, 0.089f},
       {0.715f, 0.063f, 0.008f, 0.001f, 0.001f, 0.001f, 0.002f, 0.212f},
       {0.493f, 0.051f, 0.005f, 0.001f, 0.001f, 0.001f, 0.001f, 0.451f}}},
     2},
    // second between
    {{0.649f, -0.545f, -0.027f, 0, -0.050f, 0.675f, -0.470f, 0},
     {{{0.600f, 0.169f, 0.004f, 0.001f, 0.001f, 0.005f, 0.005f, 0.225f},
       {0.778f, 0.084f, 0.058f, 0.001f, 0.001f, 0.001f, 0.002f, 0.077f},
       {0.900f, 0.034f, 0.015f, 0.001f, 0.001f, 0.001f, 0.001f, 0.050f},
       {0.895f, 0.012f, 0.054f, 0.001f, 0.001f, 0.001f, 0.001f, 0.039f},
       {0.856f, 0.050f, 0.007f, 0.001f, 0.001f, 0.001f, 0.001f, 0.088f},
       {0.611f, 0.084f, 0.008f, 0.001f, 0.001f, 0.001f, 0.001f, 0.298f}}},
     1},
    // first between
    {{0.339f, -0.111f, -0.026f, -0.150f, -0.094f, 0.337f, -0.303f, -0.170f},
     {{{0.208f, 0.471f, 0.004f, 0.001f, 0.001f, 0.006f, 0.004f, 0.313f},
       {0.586f, 0.207f, 0.058f, 0.001f, 0.001f, 0.002f, 0.001f, 0.146f},
       {0.813f, 0.095f, 0.011f, 0.001f, 0.001f, 0.001f, 0.001f, 0.079f},
       {0.879f, 0.026f, 0.016f, 0.001f, 0.001f, 0.001f, 0.001f, 0.079f},
       {0.777f, 0.042f, 0.003f, 0.001f, 0.001f, 0.001f, 0.001f, 0.178f},
       {0.537f, 0.051f, 0.003f, 0.001f, 0.001f, 0.001f, 0.001f, 0.410f}}},
     2},
}};
struct PlaceScales {
  std::array<float, 8> tangent, normal;  // logarithms
  std::array<std::array<float, 4>, 2> tangent_slopes, normal_slopes;
};
// One, second, first.
inline constexpr std::array<PlaceScales, 3> kPlaceScales{{
    {{-1.366f, -0.838f, -2.000f, -7.777f, -6.342f, 0.009f, -0.358f, -0.665f},
     {-1.032f, 0.866f, -1.873f, -8.525f, -7.578f, -0.115f, -0.001f, -1.059f},
     {{{0.340f, 0.101f, 0.453f, 0.076f}, {0.148f, 0.206f, 0.460f, -0.362f}}},
     {{{-0.285f, 0.561f, -0.334f, 0.963f}, {-0.290f, 0.419f, -0.013f, 0.502f}}}},
    {{-1.189f, -0.681f, -3.822f, -1.903f, -2.256f, -2.647f, -2.259f, -2.468f},
     {-1.552f, -0.022f, -2.562f, -1.663f, -1.650f, -1.567f, -1.565f, -3.406f},
     {{{0.329f, 0.073f, 0.375f, 0.112f}, {0.145f, 0.081f, 0.746f, -0.208f}}},
     {{{-0.295f, 0.669f, -0.275f, 0.845f}, {-0.158f, 0.306f, 0.192f, 0.454f}}}},
    {{-1.111f, -0.577f, -3.939f, -2.098f, -1.841f, -1.997f, -2.808f, -2.437f},
     {-1.480f, 0.022f, -2.505f, -1.659f, -1.974f, -1.694f, -1.505f, -3.905f},
     {{{0.380f, 0.073f, 0.346f, 0.098f}, {0.090f, 0.119f, 0.758f, -0.174f}}},
     {{{-0.335f, 0.759f, -0.373f, 0.913f}, {-0.202f, 0.332f, 0.144f, 0.582f}}}},
}};

// "Between".
inline constexpr std::array<double, 4> kInMiddle{0.25, 0.34, 0.46, 0.58};
inline constexpr std::array<double, 4> kToNearer{0.96, 0.94, 0.88, 0.67};
// To the farther child, to the nearer one.
inline constexpr std::array<std::array<double, 4>, 2> kIsOne{
    {{0.68, 0.68, 0.7, 0.68}, {0.27, 0.33, 0.46, 0.63}}};
inline constexpr std::array<std::array<double, 4>, 2> kIsTwo{
    {{0.82, 0.82, 0.85, 0.87}, {0.76, 0.8, 0.88, 0.89}}};
inline constexpr std::array<double, 4> kThirdAxis{0.97, 0.97, 0.95, 0.85};

// "Directions".
struct DirectionStart {
  std::array<float, 8> weights, logarithms;
  std::array<std::array<float, 4>, 2> slopes;
};
inline constexpr DirectionStart kOfVertices{
    {0.157f, 0.079f, 0.008f, 0.029f, 0.021f, 0.150f, 0.501f, 0.055f},
    {3.056f, 2.395f, -0.518f, 0.166f, -0.108f, -0.287f, 2.704f, 0.894f},
    {{{0.314f, 0.251f, 0.084f, -0.075f}, {0.194f, 0.132f, 0.119f, -0.076f}}}};
inline constexpr DirectionStart kOfCorners{
    {0.273f, 0.231f, 0.037f, 0.247f, 0.063f, 0.037f, 0.062f, 0.050f},
    {6.823f, 5.426f, 2.401f, 4.111f, 2.441f, 1.739f, 2.336f, 2.020f},
    {{{0.381f, 0.305f, -0.288f, 0.123f}, {0.370f, 0.253f, -0.118f, 0.031f}}}};

}  // namespace plain

// A tile of a picture out of framebuffers with more pixels than it has.
#pragma once

#include "crease/render.h"
#include "render/layout.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// Each pixel of the picture is so many by so many of the framebuffer, with 4 samples each: edges
// get 17 steps, and highlights and lines do not flicker between neighbours.
inline constexpr int kSupersampling = 2;

class AveragedTile {
 public:
  // In pixels of the picture.
  AveragedTile(int width, int height)
      : width_(width), height_(height), sums_(std::size_t(width) * std::size_t(height)) {}

  // A drawing of kSupersampling times as many pixels each way, as GlTarget::read() gives it. All
  // that are added count the same.
  void add(std::span<const std::uint8_t> rgba);
  // Over what the picture has there, which is opaque.
  void lay_over(Image& image, int x, int y) const;

 private:
  struct Sum {
    float light[3] = {}, cover = 0;  // light times cover, in 1 for a drawing
  };
  int width_, height_;
  int drawings_ = 0;
  std::vector<Sum> sums_;  // top row first
};

}  // namespace crease

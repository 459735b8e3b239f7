// Colours of vertices or of faces, as an OFF has them.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace crease {

// A row each: whole numbers up to 255, others up to 1 (Geomview's OFF). Some programs write whole
// numbers up to 1, or others up to 255, so the most that a kind has in the file decides.
class OffColors {
 public:
  bool empty() const { return values_.empty(); }

  // Three components, or four with alpha.
  void add(std::span<const double> components, bool is_whole) {
    for (std::size_t i = 0; i < 4; ++i) {
      const bool is_there = i < components.size();
      values_.push_back(is_there ? static_cast<float>(components[i]) : kFull);
      if (is_there && components[i] > 1) is_up_to_255_[is_whole] = true;
    }
    is_whole_.push_back(is_whole);
  }
  // White up to row `row_count`.
  void fill(std::size_t row_count) {
    values_.resize(4 * row_count, kFull);
    is_whole_.resize(row_count);
  }
  // Four a row, 0..1.
  std::vector<float> take() {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      float& c = values_[i];
      c = c == kFull ? 1.0f : is_up_to_255_[is_whole_[i / 4]] ? c / 255.0f : c;
    }
    return std::move(values_);
  }

 private:
  static constexpr float kFull = -1;  // no component of a file is below 0

  std::vector<float> values_;
  std::vector<bool> is_whole_;          // of rows
  std::array<bool, 2> is_up_to_255_{};  // by kind
};

}  // namespace crease

#include "io/binary_off.h"

#include "base/bytes.h"

#include <bit>

namespace crease {

namespace {

constexpr std::size_t kWord = 4, kCounts = 3 * kWord;  // vertices, faces, edges

std::uint32_t swapped(std::uint32_t x) {
  return x >> 24 | (x >> 8 & 0xff00) | (x & 0xff00) << 8 | x << 24;
}

}  // namespace

std::uint32_t BinaryOff::word_at(std::size_t offset) const {
  const std::uint32_t word = u32_at(bytes_, offset);
  return is_big_endian_ ? swapped(word) : word;
}

float BinaryOff::float_at(std::size_t offset) const {
  return std::bit_cast<float>(word_at(offset));
}

bool BinaryOff::counts_fit() {
  vertex_count_ = word_at(0);
  face_count_ = word_at(kWord);
  const std::size_t left = bytes_.size() - kCounts;
  const std::size_t vertices = vertex_count_ * floats_per_vertex_ * kWord;
  return vertices <= left && face_count_ <= (left - vertices) / kWord;
}

std::optional<std::size_t> BinaryOff::end_of_faces(bool are_colors_counted) const {
  std::size_t at = kCounts + vertex_count_ * floats_per_vertex_ * kWord;
  const auto skip = [&](std::size_t least) {  // a number of words and they
    if (bytes_.size() - at < kWord) return false;
    const std::size_t words = word_at(at);
    at += kWord;
    if (words < least || words > (bytes_.size() - at) / kWord) return false;
    at += words * kWord;
    return true;
  };
  for (std::size_t f = 0; f < face_count_; ++f) {
    // A face without corners is the colour that another does not have.
    if (!skip(are_colors_counted ? 0 : 1) || (are_colors_counted && !skip(0))) return std::nullopt;
  }
  return at;
}

bool BinaryOff::open() {
  if (bytes_.size() < kCounts) return false;
  is_big_endian_ = true;
  if (!counts_fit()) {
    is_big_endian_ = false;
    if (!counts_fit()) return false;
  }
  const auto counted = end_of_faces(true), bare = end_of_faces(false);
  are_colors_counted_ = bare != bytes_.size() || counted == bytes_.size();
  at_ = kCounts;
  return counted || !are_colors_counted_;
}

void BinaryOff::take_vertex(std::span<float> row) {
  for (float& x : row) {
    x = float_at(at_);
    at_ += kWord;
  }
}

void BinaryOff::take_face(std::vector<std::uint32_t>& corners, std::vector<double>& color) {
  corners.resize(word_at(at_));
  at_ += kWord;
  for (std::uint32_t& corner : corners) {
    corner = word_at(at_);
    at_ += kWord;
  }
  color.clear();
  if (!are_colors_counted_) return;
  const std::size_t count = word_at(at_);
  at_ += kWord;
  for (std::size_t i = 0; i < count; ++i, at_ += kWord) {
    if (i < 4) color.push_back(count < 3 ? word_at(at_) : static_cast<double>(float_at(at_)));
  }
}

}  // namespace crease

// The header of a PLY file: which elements with which properties follow, in which encoding.
#pragma once

#include "crease/result.h"
#include "io/formats.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace crease {

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
std::size_t size_of(PlyType type);
inline bool is_integer(PlyType type) {
  return type < PlyType::Float32;
}

struct PlyProperty {
  std::string name;
  PlyType type{};  // of the value, or of a list's items
  bool is_list = false;
  PlyType count_type{};  // of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  // Bytes that a row takes at least: lists may be empty; a number in text takes a digit and a
  // blank.
  std::size_t least_bytes(bool is_text) const;
};

enum class PlyEncoding { Text, LittleEndian, BigEndian };

struct PlyHeader {
  PlyEncoding encoding{};
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;
  std::vector<std::string> unknown_words;  // that other lines begin with
  std::size_t byte_count = 0;              // the body begins here
  std::size_t line_count = 0;
};

Result<PlyHeader> read_ply_header(const Source& source);

}  // namespace crease

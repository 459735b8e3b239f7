// The rows of a binary OFF: Geomview's, which is big-endian with the number of a colour's
// components behind each face, and those of other programs, which write as their machine does,
// without colours.
//
//   BinaryOff rows(bytes, floats_per_vertex);   // bytes: what follows "OFF BINARY\n"
//   if (!rows.open()) return fail(...);
//   for (v < rows.vertex_count()) rows.take_vertex(floats);
//   for (f < rows.face_count()) rows.take_face(corners, color);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace crease {

class BinaryOff {
 public:
  BinaryOff(std::span<const std::byte> bytes, std::size_t floats_per_vertex)
      : bytes_(bytes), floats_per_vertex_(floats_per_vertex) {}

  // Finds out how the numbers lie. False: vertices and faces do not fit into the bytes in any way.
  bool open();
  std::size_t vertex_count() const { return vertex_count_; }
  std::size_t face_count() const { return face_count_; }

  // The next row. Vertices first; all are there.
  void take_vertex(std::span<float> row);
  // `color`: three or four components, an index into a table, or nothing.
  void take_face(std::vector<std::uint32_t>& corners, std::vector<double>& color);

  // Of the next row.
  std::size_t offset() const { return at_; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::uint32_t word_at(std::size_t offset) const;
  float float_at(std::size_t offset) const;
  bool counts_fit();
  // Behind the last face; nothing if that is beyond the bytes.
  std::optional<std::size_t> end_of_faces(bool are_colors_counted) const;

  std::span<const std::byte> bytes_;
  std::size_t floats_per_vertex_;
  bool is_big_endian_ = true, are_colors_counted_ = true;
  std::size_t vertex_count_ = 0, face_count_ = 0, at_ = 0;
};

}  // namespace crease

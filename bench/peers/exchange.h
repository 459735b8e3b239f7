// The file through which a mesh goes to a peer and comes back. Little-endian:
//
//   "CRMX"  u32 vertices  u32 triangles  u32 has normals
//   f64 positions[3 * vertices]  u32 corners[3 * triangles]  f32 normals[9 * triangles]
//
// Needs nothing of crease, since peers link nothing of it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace exchange {

struct Mesh {
  std::vector<double> positions;
  std::vector<std::uint32_t> corners;  // vertex of each triangle corner
  std::vector<float> normals;          // of each triangle corner; empty: none

  std::size_t vertex_count() const { return positions.size() / 3; }
  std::size_t triangle_count() const { return corners.size() / 3; }
};

inline bool write_mesh(const std::string& path, const Mesh& mesh) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return false;
  const std::uint32_t counts[3] = {static_cast<std::uint32_t>(mesh.vertex_count()),
                                   static_cast<std::uint32_t>(mesh.triangle_count()),
                                   mesh.normals.empty() ? 0u : 1u};
  const auto put = [&](const void* data, std::size_t size, std::size_t count) {
    return std::fwrite(data, size, count, file) == count;
  };
  const bool written = put("CRMX", 1, 4) && put(counts, 4, 3) &&
                       put(mesh.positions.data(), 8, mesh.positions.size()) &&
                       put(mesh.corners.data(), 4, mesh.corners.size()) &&
                       put(mesh.normals.data(), 4, mesh.normals.size());
  return (std::fclose(file) == 0) && written;
}

inline bool read_mesh(const std::string& path, Mesh& mesh) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return false;
  char magic[4];
  std::uint32_t counts[3];
  const auto get = [&](void* data, std::size_t size, std::size_t count) {
    return std::fread(data, size, count, file) == count;
  };
  bool read = get(magic, 1, 4) && std::memcmp(magic, "CRMX", 4) == 0 && get(counts, 4, 3);
  if (read) {
    mesh.positions.resize(std::size_t(3) * counts[0]);
    mesh.corners.resize(std::size_t(3) * counts[1]);
    mesh.normals.resize(counts[2] == 0 ? 0 : std::size_t(9) * counts[1]);
    read = get(mesh.positions.data(), 8, mesh.positions.size()) &&
           get(mesh.corners.data(), 4, mesh.corners.size()) &&
           get(mesh.normals.data(), 4, mesh.normals.size());
  }
  std::fclose(file);
  return read;
}

}  // namespace exchange

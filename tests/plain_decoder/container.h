// docs/format.md: the head, names and tables, and the directory of a file, out of its bytes.
#pragma once

#include "plain_decoder/arithmetic.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace plain {

using Bytes = std::vector<std::byte>;

struct Layer {
  std::string name;
  std::uint8_t role = 0, interpolation = 0, dimension = 0, coding = 0, bits = 0;
};

using Errors = std::array<float, 4>;  // surface, line, degrees, texture

struct Band {
  std::uint32_t patches = 0;
  std::uint64_t contractions = 0, triangles_after = 0;
  Errors errors{};
};

struct Part {  // of the file, with a checksum
  std::uint64_t bytes = 0, checksum = 0;
};

struct PageReference {
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0;
};

struct Head {
  int version = 0, layout = 0;
  std::uint32_t bytes = 0;  // of the head
  std::uint64_t file_bytes = 0;
  std::uint32_t blocks = 0;
  std::uint64_t vertices = 0, triangles = 0;
  std::array<double, 3> origin{};
  double step = 0;
  std::uint8_t grid_bits = 0, up = 0;
  std::uint32_t parts = 0;
  Part materials, part_names, tables, image_list;
  std::uint64_t image_bytes = 0;  // of all of them
  std::vector<Layer> layers;
  std::vector<Band> bands;
  std::vector<PageReference> pages;
};

struct Material {
  std::string name;
  std::array<float, 4> colour{};
  std::string texture;
  float cutoff = 0;
  bool double_sided = false, blended = false;
};

struct Lattice {
  float divisor = 1;
  std::int32_t least = 0, greatest = 0;
  std::vector<float> entries;
  std::int32_t grain = 1;
};

struct Entry {
  std::uint64_t offset = 0;
  std::uint32_t checksum = 0, bytes = 0, memory = 0;
  std::uint16_t band = 0;
  std::uint32_t patch = 0;
  Point centre;
  std::uint32_t radius = 0;
  std::uint32_t splits = 0, vertices = 0, coarse_triangles = 0, fine_triangles = 0;
  Errors coarse{}, fine{};
  std::vector<std::uint32_t> needs;
};

struct ImageOfFile {
  std::string name;
  Bytes bytes;
};

// Everything but payloads, which are bytes.
struct Container {
  Head head;
  std::vector<Material> materials;
  std::vector<std::string> part_names;
  Bytes tables;
  std::vector<Entry> entries;  // per block
  std::vector<ImageOfFile> images;
};

// All checksums but those of payloads are verified. Throws Refused.
Container read_container(const Bytes& file);

// "Materials, part names, lattices": of each layer one lattice a component; none where its
// coding is another.
std::vector<std::vector<Lattice>> read_lattices(const std::vector<Layer>& layers,
                                                const Bytes& tables);

// The checksum is verified.
Bytes read_payload(const Bytes& file, const Entry& entry);

}  // namespace plain

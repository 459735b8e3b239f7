// model.crease: one file, read and written whole in this first version (docs/format.md).
//
//   Result<CreaseFile> file = read_crease("city.crease", {});
//   ProgressiveMesh pm(file->arrays);
#pragma once

#include "crease/progressive_arrays.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace crease {

struct FileInfo {
  std::uint16_t version = 0;
  std::uint64_t bytes = 0;
  struct Section {
    std::string name;  // "positions", "contractions", ...
    std::uint64_t offset = 0, bytes = 0;
  };
  std::vector<Section> sections;
  struct Band {
    std::uint32_t patches = 0, contractions = 0, triangles_after = 0;
    float surface_error = 0;
  };
  std::vector<Band> bands;
};

struct CreaseFile {
  ProgressiveArraysPtr arrays;
  FileInfo info;
};

struct DecodeLimits {
  std::uint64_t max_bytes = std::uint64_t(16) << 30;  // memory a file may ask for
};

// A decoder given hostile bytes returns a Failure naming the section and offset; it never crashes,
// hangs, or takes more memory than a small multiple of the bytes given.
Result<CreaseFile> decode_crease(std::span<const std::byte> bytes, const DecodeLimits& limits);
std::vector<std::byte> encode_crease(const ProgressiveArrays& arrays,
                                     std::span<const FileInfo::Band> bands);

Result<CreaseFile> read_crease(const std::filesystem::path& path, const DecodeLimits& limits);
// The file appears under its name only when it is complete.
Status write_crease(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Every checksum and every invariant: sections, index ranges, each contraction forwards and
// backwards, the same arrays at the end as at the start. Empty: all hold.
std::vector<std::string> validate_crease(std::span<const std::byte> bytes);

}  // namespace crease

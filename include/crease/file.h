// model.crease by its name.
//
//   Result<BlockFile> file = open_crease("city.crease");
//   Result<DecodedModel> model = decode_model(*file);
#pragma once

#include "crease/block_file.h"
#include "crease/decode_model.h"
#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace crease {

// Reads the head alone, at most 64 KiB. The file stays open as long as the BlockFile lives.
Result<BlockFile> open_crease(const std::filesystem::path& path);

// The file appears under its name only when it is complete.
Status write_crease(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Every checksum and every invariant: head, pages, blocks; that all of them decode, to the counts
// that directory and head tell; the contraction sequence of them (check_contractions()). Empty: all
// hold. `options`: threads and limits.
std::vector<std::string> validate_crease(const BlockFile& file, const DecodeOptions& options = {});

}  // namespace crease

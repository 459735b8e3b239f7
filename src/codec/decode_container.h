// The parts of a file, from bytes that were read already. BlockFile reads them from a
// ByteSource; who fetches bytes another way calls these.
#pragma once

#include "codec/checksum.h"
#include "crease/block_file.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

// `start`: the first bytes of a file that has `size` bytes so far: 65,536 of them, or all.
Result<BlockFileHead> decode_head(std::span<const std::byte> start, std::uint64_t size,
                                  Checksums checksums);

// `bytes`: all of head.pages[page]. `max_bytes`: of memory, as BlockFileLimits counts it.
Result<DirectoryPage> decode_page(std::span<const std::byte> bytes, const BlockFileHead& head,
                                  std::uint32_t page, Checksums checksums,
                                  std::uint64_t max_bytes = BlockFileLimits{}.max_bytes);

// `bytes`: all of the section, whose checksum is right; none: there are no names. `layout`,
// `count`: as the head says. `max_bytes`: of memory, the section's included.
Result<std::vector<Material>> decode_materials(std::span<const std::byte> bytes,
                                               std::uint16_t layout);
Result<std::vector<std::string>> decode_parts(
    std::span<const std::byte> bytes, std::uint32_t count,
    std::uint64_t max_bytes = BlockFileLimits{}.max_bytes);

// `bytes`: all of head.image_list, whose checksum is right; none: there are no images.
Result<std::vector<ImageEntry>> decode_image_list(std::span<const std::byte> bytes,
                                                  const BlockFileHead& head);

std::string page_name(const BlockFileHead& head, std::uint32_t page);  // "page 3 at byte 81920"
std::string block_name(const BlockEntry& entry);                       // "block 17 at byte 81920"
std::string image_name(const ImageEntry& entry);  // "image 'wood.png' at byte 81920"

}  // namespace crease

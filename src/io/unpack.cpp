#include "io/unpack.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>

#include <lzma.h>
#include <zstd.h>

namespace crease {

namespace {

constexpr std::size_t kChunk = std::size_t(1) << 20;
constexpr int kMaxWindowLog = 27;  // 128 MiB
constexpr std::uint64_t kMaxXzMemory = std::uint64_t(128) << 20;

std::size_t limit_for(std::size_t packed) {
  return std::max(kUnpackedAlways, packed * kMaxUnpackedTimes);
}

Failure cut_off(const std::string& name, std::size_t offset) {
  return fail(Error::Truncated, name + ": packed byte " + std::to_string(offset) +
                                    ": the packed file is cut off; fetch it again");
}

Failure damaged(const std::string& name, std::size_t offset, const std::string& why) {
  return fail(Error::BadFormat, name + ": packed byte " + std::to_string(offset) + ": " + why +
                                    "; fetch the file again");
}

Failure bomb(const std::string& name) {
  return fail(Error::OverLimit, name + ": unpacks to more than " +
                                    std::to_string(kMaxUnpackedTimes) + " times its size");
}

// Only to save the doubling of a growing array: a promise is not trusted beyond the limit, and
// memory that is never written is never taken.
void reserve_promised(std::vector<std::byte>& out, std::uint64_t promised, std::size_t packed) {
  if (promised <= limit_for(packed)) out.reserve(static_cast<std::size_t>(promised) + kChunk);
}

// What the index at the end of the last stream says; 0 if there is none to be read.
std::uint64_t unpacked_size_of_xz(std::span<const std::byte> bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  lzma_stream_flags footer;
  if (bytes.size() < 2 * LZMA_STREAM_HEADER_SIZE) return 0;
  const std::size_t footer_at = bytes.size() - LZMA_STREAM_HEADER_SIZE;
  if (lzma_stream_footer_decode(&footer, data + footer_at) != LZMA_OK) return 0;
  if (footer.backward_size > footer_at) return 0;
  lzma_index* index = nullptr;
  std::uint64_t memory = kMaxXzMemory;
  std::size_t at = footer_at - static_cast<std::size_t>(footer.backward_size);
  if (lzma_index_buffer_decode(&index, &memory, nullptr, data, &at, footer_at) != LZMA_OK) return 0;
  const std::uint64_t size = lzma_index_uncompressed_size(index);
  lzma_index_end(index, nullptr);
  return size;
}

Result<std::vector<std::byte>> unpack_zstd(std::span<const std::byte> bytes,
                                           const std::string& name) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  ZSTD_DCtx_setParameter(stream.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  std::vector<std::byte> out;
  const unsigned long long promised = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (promised != ZSTD_CONTENTSIZE_UNKNOWN && promised != ZSTD_CONTENTSIZE_ERROR) {
    reserve_promised(out, promised, bytes.size());
  }
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  const std::size_t limit = limit_for(bytes.size());
  std::size_t state = 1;  // 0: at the end of a frame
  while (true) {
    const std::size_t before = out.size();
    out.resize(before + kChunk);
    ZSTD_outBuffer chunk{out.data() + before, out.size() - before, 0};
    state = ZSTD_decompressStream(stream.get(), &chunk, &in);
    out.resize(before + chunk.pos);
    if (ZSTD_isError(state)) return damaged(name, in.pos, ZSTD_getErrorName(state));
    if (out.size() > limit) return bomb(name);
    const bool output_full = chunk.pos == chunk.size;
    if (in.pos == in.size && (state == 0 || !output_full)) break;
  }
  if (state != 0) return cut_off(name, bytes.size());
  return out;
}

Result<std::vector<std::byte>> unpack_xz(std::span<const std::byte> bytes,
                                         const std::string& name) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, kMaxXzMemory, LZMA_CONCATENATED) != LZMA_OK) {
    return fail(Error::NotSupported, name + ": the xz decoder does not start");
  }
  const std::unique_ptr<lzma_stream, decltype(&lzma_end)> ends(&stream, &lzma_end);
  std::vector<std::byte> out;
  reserve_promised(out, unpacked_size_of_xz(bytes), bytes.size());
  stream.next_in = reinterpret_cast<const std::uint8_t*>(bytes.data());
  stream.avail_in = bytes.size();
  const std::size_t limit = limit_for(bytes.size());
  lzma_ret state = LZMA_OK;
  while (state == LZMA_OK) {
    const std::size_t before = out.size();
    out.resize(before + kChunk);
    stream.next_out = reinterpret_cast<std::uint8_t*>(out.data() + before);
    stream.avail_out = out.size() - before;
    state = lzma_code(&stream, LZMA_FINISH);
    out.resize(out.size() - stream.avail_out);
    if (out.size() > limit) return bomb(name);
  }
  const std::size_t offset = bytes.size() - stream.avail_in;
  if (state == LZMA_BUF_ERROR) return cut_off(name, bytes.size());
  if (state == LZMA_MEMLIMIT_ERROR)
    return damaged(name, offset, "wants more than 128 MiB to unpack");
  if (state != LZMA_STREAM_END) return damaged(name, offset, "not xz data");
  return out;
}

}  // namespace

Packing packing_of(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 4> kZstd{0x28, 0xb5, 0x2f, 0xfd};
  constexpr std::array<unsigned char, 6> kXz{0xfd, '7', 'z', 'X', 'Z', 0};
  const auto begins_with = [&](const auto& magic) {
    return bytes.size() >= magic.size() &&
           std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
  };
  // What a reader skips: sizes, as pzstd writes them before each frame.
  const bool is_skipped = bytes.size() >= 4 && (bytes[0] & std::byte{0xf0}) == std::byte{0x50} &&
                          bytes[1] == std::byte{0x2a} && bytes[2] == std::byte{0x4d} &&
                          bytes[3] == std::byte{0x18};
  return begins_with(kZstd) || is_skipped ? Packing::Zstd
         : begins_with(kXz)               ? Packing::Xz
                                          : Packing::None;
}

std::string_view without_packing(std::string_view name) {
  for (std::string_view ending : {".zst", ".xz"}) {
    if (name.ends_with(ending)) name.remove_suffix(ending.size());
  }
  return name;
}

Result<std::vector<std::byte>> unpack(std::span<const std::byte> bytes, Packing packing,
                                      const std::string& name) {
  return packing == Packing::Zstd ? unpack_zstd(bytes, name) : unpack_xz(bytes, name);
}

}  // namespace crease

#include "io/unpack.h"

#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <lzma.h>
#include <zstd.h>

#include <string>

namespace crease {
namespace {

std::string zstd_of(const std::string& text) {
  std::string out(ZSTD_compressBound(text.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), text.data(), text.size(), 3));
  return out;
}

std::string xz_of(const std::string& text) {
  std::string out(lzma_stream_buffer_bound(text.size()), '\0');
  std::size_t size = 0;
  REQUIRE(lzma_easy_buffer_encode(1, LZMA_CHECK_CRC32, nullptr,
                                  reinterpret_cast<const std::uint8_t*>(text.data()), text.size(),
                                  reinterpret_cast<std::uint8_t*>(out.data()), &size,
                                  out.size()) == LZMA_OK);
  out.resize(size);
  return out;
}

Result<std::vector<std::byte>> unpacked(const std::string& packed) {
  const auto bytes = std::as_bytes(std::span(packed));
  return unpack(bytes, packing_of(bytes), "a");
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_CASE("packed files are told by their bytes and imported whatever their name") {
  for (const std::string& packed : {zstd_of(kObj), xz_of(kObj)}) {
    CHECK(import_text(packed, "a.obj").mesh.triangle_count() == 1);
    CHECK(import_text(packed, "a.obj.xz").mesh.triangle_count() == 1);
  }
  CHECK(without_packing("city.obj.xz") == "city.obj");
  CHECK(without_packing("city.obj.zst") == "city.obj");
}

TEST_CASE("other packings are refused by their names, whatever the file's") {
  for (const char* name : {"a.glb", "a.obj", "a.json", "a.3mf"}) {
    CHECK(refusal_of("\x1f\x8b\b", name) ==
          std::string(name) +
              ": byte 0: packed with gzip; unpack it first (.zst and .xz need not be)");
    CHECK(refusal_of("PK\x03\x04", name).find("packed with zip") != std::string::npos);
  }
}

TEST_CASE("large content and several streams in a row come out whole") {
  std::string text;
  for (long i = 0; i < 400'000; ++i) text += std::to_string(i * 7919);
  for (const std::string& packed :
       {zstd_of(text), xz_of(text), zstd_of(text) + zstd_of(text), xz_of(text) + xz_of(text)}) {
    const auto out = unpacked(packed);
    REQUIRE(out.ok());
    CHECK(out->size() % text.size() == 0);
    const std::string_view first(reinterpret_cast<const char*>(out->data()), text.size());
    const bool is_equal = first == text;  // megabytes are not for CHECK to print
    CHECK(is_equal);
  }
}

TEST_CASE("content of a megabyte to the byte, and frames that are to be skipped") {
  for (const std::size_t size : {(std::size_t(1) << 20) - 1, std::size_t(1) << 20,
                                 (std::size_t(1) << 20) + 1, std::size_t(2) << 20}) {
    const std::string text(size, 'x');
    for (const std::string& packed : {zstd_of(text), xz_of(text)}) {
      const auto out = unpacked(packed);
      REQUIRE(out.ok());
      CHECK(out->size() == size);
    }
  }
  using namespace std::string_literals;
  const auto out = unpacked("\x53\x2a\x4d\x18\x03\x00\x00\x00"s + "abc" + zstd_of(kObj));
  REQUIRE(out.ok());
  CHECK(out->size() == std::string(kObj).size());
}

TEST_CASE("a packed file cut anywhere is refused") {
  for (const std::string& packed : {zstd_of(kObj), xz_of(kObj)}) {
    for (std::size_t size = 6; size < packed.size(); ++size) {
      CAPTURE(size);
      CHECK_FALSE(unpacked(packed.substr(0, size)).ok());
    }
    const std::string half = packed.substr(0, packed.size() / 2);
    CHECK(unpacked(half).failure().message.find("byte " + std::to_string(half.size())) !=
          std::string::npos);
  }
}

TEST_CASE("a bomb is refused before it takes its memory") {
  const std::string zeros(std::size_t(80) << 20, '\0');
  for (const std::string& packed : {zstd_of(zeros), xz_of(zeros)}) {
    REQUIRE(packed.size() * kMaxUnpackedTimes < zeros.size());
    const auto out = unpacked(packed);
    REQUIRE(!out.ok());
    CHECK(out.failure().error == Error::OverLimit);
  }
}

}  // namespace
}  // namespace crease

#include "plain_decoder/checksum.h"

#include <array>

namespace plain {

namespace {

constexpr std::array<std::uint8_t, 192> kSecret{
    0xb8, 0xfe, 0x6c, 0x39, 0x23, 0xa4, 0x4b, 0xbe, 0x7c, 0x01, 0x81, 0x2c, 0xf7, 0x21, 0xad, 0x1c,
    0xde, 0xd4, 0x6d, 0xe9, 0x83, 0x90, 0x97, 0xdb, 0x72, 0x40, 0xa4, 0xa4, 0xb7, 0xb3, 0x67, 0x1f,
    0xcb, 0x79, 0xe6, 0x4e, 0xcc, 0xc0, 0xe5, 0x78, 0x82, 0x5a, 0xd0, 0x7d, 0xcc, 0xff, 0x72, 0x21,
    0xb8, 0x08, 0x46, 0x74, 0xf7, 0x43, 0x24, 0x8e, 0xe0, 0x35, 0x90, 0xe6, 0x81, 0x3a, 0x26, 0x4c,
    0x3c, 0x28, 0x52, 0xbb, 0x91, 0xc3, 0x00, 0xcb, 0x88, 0xd0, 0x65, 0x8b, 0x1b, 0x53, 0x2e, 0xa3,
    0x71, 0x64, 0x48, 0x97, 0xa2, 0x0d, 0xf9, 0x4e, 0x38, 0x19, 0xef, 0x46, 0xa9, 0xde, 0xac, 0xd8,
    0xa8, 0xfa, 0x76, 0x3f, 0xe3, 0x9c, 0x34, 0x3f, 0xf9, 0xdc, 0xbb, 0xc7, 0xc7, 0x0b, 0x4f, 0x1d,
    0x8a, 0x51, 0xe0, 0x4b, 0xcd, 0xb4, 0x59, 0x31, 0xc8, 0x9f, 0x7e, 0xc9, 0xd9, 0x78, 0x73, 0x64,
    0xea, 0xc5, 0xac, 0x83, 0x34, 0xd3, 0xeb, 0xc3, 0xc5, 0x81, 0xa0, 0xff, 0xfa, 0x13, 0x63, 0xeb,
    0x17, 0x0d, 0xdd, 0x51, 0xb7, 0xf0, 0xda, 0x49, 0xd3, 0x16, 0x55, 0x26, 0x29, 0xd4, 0x68, 0x9e,
    0x2b, 0x16, 0xbe, 0x58, 0x7d, 0x47, 0xa1, 0xfc, 0x8f, 0xf8, 0xb8, 0xd1, 0x7a, 0xd0, 0x31, 0xce,
    0x45, 0xcb, 0x3a, 0x8f, 0x95, 0x16, 0x04, 0x28, 0xaf, 0xd7, 0xfb, 0xca, 0xbb, 0x4b, 0x40, 0x7e,
};
constexpr std::uint64_t kPrime32_1 = 0x9e3779b1u, kPrime32_2 = 0x85ebca77u,
                        kPrime32_3 = 0xc2b2ae3du;
constexpr std::uint64_t kPrime64_1 = 0x9e3779b185ebca87u, kPrime64_2 = 0xc2b2ae3d27d4eb4fu,
                        kPrime64_3 = 0x165667b19e3779f9u, kPrime64_4 = 0x85ebca77c2b2ae63u,
                        kPrime64_5 = 0x27d4eb2f165667c5u;
constexpr std::uint64_t kMix1 = 0x165667919e3779f9u, kMix2 = 0x9fb21c651e98df25u;

using Bytes = std::vector<std::byte>;

std::uint64_t u64_of(std::size_t count, const auto& byte_at) {
  std::uint64_t x = 0;
  for (std::size_t i = count; i-- > 0;) x = x << 8 | byte_at(i);
  return x;
}
std::uint64_t u64(const Bytes& bytes, std::size_t at) {
  return u64_of(8, [&](std::size_t i) { return std::to_integer<std::uint64_t>(bytes[at + i]); });
}
std::uint64_t u32(const Bytes& bytes, std::size_t at) {
  return u64_of(4, [&](std::size_t i) { return std::to_integer<std::uint64_t>(bytes[at + i]); });
}
std::uint64_t secret64(std::size_t at) {
  return u64_of(8, [&](std::size_t i) { return std::uint64_t(kSecret[at + i]); });
}
std::uint64_t secret32(std::size_t at) {
  return u64_of(4, [&](std::size_t i) { return std::uint64_t(kSecret[at + i]); });
}

std::uint64_t turned(std::uint64_t x, int bits) {
  return x << bits | x >> (64 - bits);
}
std::uint64_t bytes_reversed(std::uint64_t x) {
  std::uint64_t y = 0;
  for (int i = 0; i < 8; ++i) y = y << 8 | (x >> 8 * i & 0xff);
  return y;
}

// The two halves of the product of 128 bits, put together.
std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
  const std::uint64_t low = a0 * b0, mid = a1 * b0 + (low >> 32),
                      other = a0 * b1 + (mid & 0xffffffffu);
  const std::uint64_t high = a1 * b1 + (mid >> 32) + (other >> 32);
  return (other << 32 | (low & 0xffffffffu)) ^ high;
}

std::uint64_t avalanche64(std::uint64_t h) {
  h = (h ^ h >> 33) * kPrime64_2;
  h = (h ^ h >> 29) * kPrime64_3;
  return h ^ h >> 32;
}
std::uint64_t avalanche(std::uint64_t h) {
  h = (h ^ h >> 37) * kMix1;
  return h ^ h >> 32;
}

std::uint64_t of_1_to_3(const Bytes& in) {
  const std::size_t n = in.size();
  const auto byte = [&](std::size_t i) { return std::to_integer<std::uint64_t>(in[i]); };
  const std::uint64_t x = byte(n - 1) | n << 8 | byte(0) << 16 | byte(n >> 1) << 24;
  return avalanche64(x ^ (secret32(0) ^ secret32(4)));
}

std::uint64_t of_4_to_8(const Bytes& in) {
  const std::size_t n = in.size();
  const std::uint64_t x = u32(in, n - 4) + (u32(in, 0) << 32);
  std::uint64_t h = x ^ (secret64(8) ^ secret64(16));
  h ^= turned(h, 49) ^ turned(h, 24);
  h *= kMix2;
  h ^= (h >> 35) + n;
  h *= kMix2;
  return h ^ h >> 28;
}

std::uint64_t of_9_to_16(const Bytes& in) {
  const std::size_t n = in.size();
  const std::uint64_t low = u64(in, 0) ^ (secret64(24) ^ secret64(32));
  const std::uint64_t high = u64(in, n - 8) ^ (secret64(40) ^ secret64(48));
  return avalanche(n + bytes_reversed(low) + high + folded_product(low, high));
}

std::uint64_t mixed(const Bytes& in, std::size_t at, std::size_t secret) {
  return folded_product(u64(in, at) ^ secret64(secret), u64(in, at + 8) ^ secret64(secret + 8));
}

std::uint64_t of_17_to_128(const Bytes& in) {
  const std::size_t n = in.size();
  std::uint64_t sum = n * kPrime64_1;
  for (std::size_t i = (n - 1) / 32 + 1; i-- > 0;) {
    sum += mixed(in, 16 * i, 32 * i);
    sum += mixed(in, n - 16 * (i + 1), 32 * i + 16);
  }
  return avalanche(sum);
}

std::uint64_t of_129_to_240(const Bytes& in) {
  const std::size_t n = in.size(), rounds = n / 16;
  std::uint64_t sum = n * kPrime64_1;
  for (std::size_t i = 0; i < 8; ++i) sum += mixed(in, 16 * i, 16 * i);
  sum = avalanche(sum);
  for (std::size_t i = 8; i < rounds; ++i) sum += mixed(in, 16 * i, 16 * (i - 8) + 3);
  sum += mixed(in, n - 16, 136 - 17);
  return avalanche(sum);
}

using Lanes = std::array<std::uint64_t, 8>;

void accumulate(Lanes& lanes, const Bytes& in, std::size_t at, std::size_t secret) {
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint64_t data = u64(in, at + 8 * i), key = data ^ secret64(secret + 8 * i);
    lanes[i ^ 1] += data;
    lanes[i] += (key & 0xffffffffu) * (key >> 32);
  }
}

void scramble(Lanes& lanes) {
  for (std::size_t i = 0; i < 8; ++i) {
    lanes[i] = ((lanes[i] ^ lanes[i] >> 47) ^ secret64(128 + 8 * i)) * kPrime32_1;
  }
}

std::uint64_t of_more(const Bytes& in) {
  constexpr std::size_t kStripe = 64, kStripes = 16, kBlock = kStripe * kStripes;
  Lanes lanes{kPrime32_3, kPrime64_1, kPrime64_2, kPrime64_3,
              kPrime64_4, kPrime32_2, kPrime64_5, kPrime32_1};
  const std::size_t n = in.size(), blocks = (n - 1) / kBlock;
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t s = 0; s < kStripes; ++s)
      accumulate(lanes, in, b * kBlock + s * kStripe, 8 * s);
    scramble(lanes);
  }
  const std::size_t stripes = (n - 1 - blocks * kBlock) / kStripe;
  for (std::size_t s = 0; s < stripes; ++s) {
    accumulate(lanes, in, blocks * kBlock + s * kStripe, 8 * s);
  }
  accumulate(lanes, in, n - kStripe, 192 - 64 - 7);
  std::uint64_t sum = n * kPrime64_1;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += folded_product(lanes[2 * i] ^ secret64(11 + 16 * i),
                          lanes[2 * i + 1] ^ secret64(19 + 16 * i));
  }
  return avalanche(sum);
}

}  // namespace

std::uint64_t checksum(const std::vector<std::byte>& bytes) {
  const std::size_t n = bytes.size();
  if (n == 0) return avalanche64(secret64(56) ^ secret64(64));
  if (n <= 3) return of_1_to_3(bytes);
  if (n <= 8) return of_4_to_8(bytes);
  if (n <= 16) return of_9_to_16(bytes);
  if (n <= 128) return of_17_to_128(bytes);
  if (n <= 240) return of_129_to_240(bytes);
  return of_more(bytes);
}

}  // namespace plain

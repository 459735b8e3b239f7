#include "codec/coded_numbers.h"
#include "codec/mixed_bit.h"
#include "codec/range_decoder.h"
#include "codec/range_encoder.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace crease::codec {
namespace {

struct Models {
  std::array<AdaptiveBit, 3> bits;
  TreeModel<5> tree;
  MagnitudeModel magnitude;
  SignedModel number;
};

struct Item {
  int kind;
  std::uint32_t value;
};

template <class Coder>
std::uint32_t code(Coder& coder, Models& models, const Item& item) {
  switch (item.kind) {
    case 0:
      return coder.bit(models.bits[0], item.value & 1);
    case 1:
      return coder.bit(models.bits[1], item.value % 100 == 0);
    case 2:
      return code_tree(coder, models.tree, item.value % 32);
    case 3:
      return code_magnitude(coder, models.magnitude, item.value);
    case 4:
      return std::uint32_t(code_signed(coder, models.number, std::int32_t(item.value)));
    case 5:
      return code_index(coder, item.value | 1, item.value / 2);
    case 6:
      return code_bits(coder, 5, item.value % 32);
    case 7:
      return code_bits(coder, 28, item.value >> 4);
    default:
      return coder.uniform(3, item.value % 3);
  }
}

std::vector<Item> random_items(std::uint64_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::vector<Item> items;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t bits = std::uint32_t(random() % 32);
    items.push_back({int(random() % 9), std::uint32_t(random()) >> bits});
    if (items.back().value > 0xfffffffeu - 1) items.back().value = 0;
  }
  return items;
}

}  // namespace

TEST_CASE("what a range encoder is given a range decoder returns") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const std::vector<Item> items = random_items(seed, seed % 50 * 20);
    RangeEncoder encoder;
    Models models;
    std::vector<std::uint32_t> written;
    for (const Item& item : items) written.push_back(code(encoder, models, item));
    const std::vector<std::byte> bytes = encoder.finish();

    RangeDecoder decoder(bytes);
    models = {};
    for (std::size_t i = 0; i < items.size(); ++i) {
      // The decoder must not look at the value, save for what the kind of the item needs of it.
      Item blind = items[i];
      if (blind.kind != 5) blind.value = 0;
      REQUIRE(code(decoder, models, blind) == written[i]);
    }
    CHECK(!decoder.failed());
  }
}

TEST_CASE("bits cost what their probability says") {
  std::mt19937 random(1);
  RangeEncoder encoder;
  AdaptiveBit model;
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) encoder.bit(model, random() % 50 == 0);
  const double bits = 8.0 * double(encoder.finish().size()) / kCount;
  const double entropy = -0.02 * std::log2(0.02) - 0.98 * std::log2(0.98);
  CHECK(bits < 1.06 * entropy);
  CHECK(bits > 0.95 * entropy);
}

TEST_CASE("stretching undoes squashing") {
  for (std::int32_t x = -1500; x <= 1500; ++x) {
    CHECK(std::abs(squash(x) - 4096 / (1 + std::exp(-x / 256.0))) < 16);
    CHECK(squash(stretch(std::uint32_t(squash(x)))) == squash(x));
  }
}

TEST_CASE("a mixed bit trusts the input that knows") {
  // One input sees the bit's own context, the other noise.
  std::mt19937 random(2);
  RangeEncoder mixed, alone;
  std::array<AdaptiveBit, 2> knows, single;
  std::array<AdaptiveBit, 16> noise;
  MixingWeights<2> weights;
  constexpr int kCount = 20'000;
  for (int i = 0; i < kCount; ++i) {
    const std::size_t context = random() % 2;
    const bool bit = (random() % 20 == 0) != (context == 1);
    MixedBit<2> model({&knows[context], &noise[random() % 16]}, weights);
    mixed.bit(model, bit);
    alone.bit(single[context], bit);
  }
  const double size = double(mixed.finish().size()), best = double(alone.finish().size());
  CHECK(size < 1.04 * best);
}

TEST_CASE("a range decoder knows that its bytes ended long ago") {
  RangeDecoder decoder({});
  CHECK(!decoder.failed());
  for (int i = 0; i < 100; ++i) decoder.uniform(1u << 16, 0);
  CHECK(decoder.failed());
}

}  // namespace crease::codec

// docs/format-block.md, from "The parts of a payload" on: one block.
#pragma once

#include "plain_decoder/around.h"
#include "plain_decoder/bits.h"
#include "plain_decoder/mixture.h"
#include "plain_decoder/octahedral.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plain {

// How a layer's codes are written.
struct BlockLayer {
  enum class Kind { Floats, Lattice, Octahedral, Sextant };
  Kind kind = Kind::Floats;
  int bits = 0;
  std::size_t dimension = 1;
  bool is_normal = false;                          // of role 0
  std::array<std::int32_t, 4> grains{1, 1, 1, 1};  // of the lattices

  std::size_t numbers() const { return kind == Kind::Sextant ? 1 : dimension; }  // of a code
};

struct BlockSchema {
  std::vector<BlockLayer> layers;
  std::uint32_t materials = 1, parts = 1;  // 1 where there are no names
  Rates rates = kRates;
};

struct Name {
  std::uint32_t block = 0, vertex = 0;
  auto operator<=>(const Name&) const = default;
};

struct Category {
  std::uint32_t material = 0, part = 0;
  bool operator==(const Category&) const = default;
};

// An end of a block.
struct End {
  std::vector<Point> places;             // per vertex
  std::vector<Name> names;               //
  std::vector<Triangle> triangles;       // vertices
  std::vector<Category> categories;      // per triangle
  std::vector<bool> derived;             //
  std::vector<std::vector<Code>> codes;  // per layer: of corner c of triangle t at 3 t + c
  std::vector<std::uint32_t> labels;     // per triangle; none at a coarse end
};

struct Split {
  std::uint32_t vertex = 0;          // the first child
  std::uint32_t second = 0;          // the new vertex
  std::uint32_t first_triangle = 0;  // of those that are new
  std::uint32_t triangle_count = 0;
  Point place;  // of the parent
};

struct Block {
  End fine;
  std::vector<Split> splits;
};

struct Limits {
  std::uint32_t vertices = 0, triangles = 0;  // at the fine end
};

// Block number `number` of the file. Throws Refused.
Block decode_block(std::span<const std::byte> payload, std::uint32_t number,
                   const BlockSchema& schema, const Limits& limits, const End& coarse);

// "Coarse end": of each of so many patches, from the fine ends of the band before.
std::vector<End> coarse_ends(const std::vector<End>& fine_ends, std::size_t patches);

}  // namespace plain

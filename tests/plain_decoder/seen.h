// docs/format-block.md, "Positions": seen coordinates.
#pragma once

#include "plain_decoder/mixture.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace plain {

// Along the three axes, from where the parent stood.
using Along = std::array<std::int32_t, 3>;

// Of a block.
class SeenModels {
 public:
  bool looks();  // around the next place
  void count(bool is_found);

 private:
  friend class SeenPlace;
  std::size_t looked_ = 0, found_ = 0, passed_ = 0;
  BitsBy<4> kind_;
  BitsBy<3> by_asked_, by_away_, by_model_;
  Weights weights_;
};

// Of one place.
class SeenPlace {
 public:
  // `around`: none if the block does not look. `model`: of the five.
  SeenPlace(SeenModels& models, std::size_t model, const std::vector<Along>& around)
      : models_(models), model_(model), around_(around) {}

  // What is coded along an axis: a place's coordinate less `plane`.
  std::int32_t read(RangeDecoder& in, std::size_t axis, std::int32_t plane, Axis& now, float size);
  void finish();  // after the third

 private:
  struct Coordinate {
    std::int32_t q = 0;
    std::set<std::size_t> had_by;  // vertices around, by number
    float away = 0;
    std::size_t a = 0, s = 0, m = 0, b = 0;
    bool likely = false, asked = false;
  };
  std::vector<Coordinate> coordinates(std::size_t axis, std::int32_t plane, const Axis& now);
  std::size_t class_before(const std::set<std::size_t>& had_by) const;
  bool is_likely(const Coordinate& of, float i);
  bool ask(RangeDecoder& in, std::size_t axis, std::size_t asked, const Coordinate& of);
  void learn(const std::vector<Coordinate>& all, std::int32_t coded);
  AdaptiveBit& kind(const Coordinate& of);

  SeenModels& models_;
  std::size_t model_;
  std::vector<Along> around_;
  bool is_found_ = false;
  std::vector<std::set<std::size_t>>
      before_;  // who has what was coded, per axis where somebody has
};

}  // namespace plain

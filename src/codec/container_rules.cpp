#include "codec/container_rules.h"

#include "codec/container.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crease {

namespace {

bool all_finite(const std::array<float, 4>& values) {
  return std::all_of(values.begin(), values.end(), [](float f) { return std::isfinite(f); });
}

// All four from 0 up to `most`.
bool are_errors(const LevelError& e, float most) {
  for (float f : {e.surface, e.line, e.degrees, e.texture}) {
    if (!(f >= 0 && f <= most)) return false;
  }
  return true;
}

bool any_greater(const LevelError& a, const LevelError& b) {
  return a.surface > b.surface || a.line > b.line || a.degrees > b.degrees || a.texture > b.texture;
}

// One row per AttributeCoding.
struct CodingRow {
  std::uint8_t min_bits, max_bits;
  bool of_directions;
};
constexpr CodingRow kCodings[] = {
    {0, 0, false},
    {1, 32, false},
    {4, 16, true},
    {2, 12, true},
};

std::string broken_rule_of_layer(const LayerSchema& layer) {
  if (layer.role > AttributeRole::Other) return "unknown role";
  if (layer.interpolation > Interpolation::Categorical) return "unknown interpolation";
  if (layer.dimension < 1 || layer.dimension > 4) return "its dimension is not 1 to 4";
  if (layer.role == AttributeRole::Normal && layer.dimension != 3) {
    return "normals are not of dimension 3";
  }
  if (layer.coding > AttributeCoding::Sextant) {
    return "unknown coding, or one that is no longer read: build the file again";
  }
  const CodingRow& row = kCodings[static_cast<std::size_t>(layer.coding)];
  if (layer.bits < row.min_bits || layer.bits > row.max_bits) return "bits out of range";
  if (row.of_directions &&
      (layer.dimension != 3 || layer.interpolation != Interpolation::Direction)) {
    return "a coding of directions for what is none";
  }
  return {};
}

}  // namespace

std::string broken_rule(const ModelFacts& facts) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(facts.grid.origin[i])) return "grid: its origin is not finite";
  }
  if (!std::isfinite(facts.grid.step) || !(facts.grid.step > 0)) {
    return "grid: its step is not a positive number";
  }
  if (facts.grid_bits > format::kMaxGridBits) return "grid: more than 31 bits";
  for (int i = 0; i < 3; ++i) {
    if (std::abs(facts.grid.origin[i]) > facts.grid.step * format::kMostStepsToOrigin) {
      return "grid: it lies too far away for doubles to tell its points apart";
    }
  }
  if (facts.up > UpAxis::Z) return "unknown axis for up";
  std::size_t normals = 0;
  for (std::size_t l = 0; l < facts.layers.size(); ++l) {
    const std::string where = "layer " + std::to_string(l) + ": ";
    if (std::string wrong = broken_rule_of_layer(facts.layers[l]); !wrong.empty()) {
      return where + wrong;
    }
    if (facts.layers[l].role == AttributeRole::Normal && normals++ > 0) {
      return where + "a second layer of normals";
    }
  }
  for (std::size_t b = 0; b < facts.bands.size(); ++b) {
    if (!are_errors(facts.bands[b].error, std::numeric_limits<float>::max())) {
      return "band " + std::to_string(b) + ": an error is no finite number from 0 on";
    }
  }
  return {};
}

std::string broken_rule(const Material& material) {
  if (!all_finite(material.base_color)) return "a colour is not finite";
  const float cutoff = material.alpha_cutoff;
  return cutoff >= 0 && std::isfinite(cutoff) ? "" : "a cutoff of alpha is no number from 0 on";
}

std::string broken_rule(std::vector<std::string_view> names_of_images) {
  std::vector<std::string_view>& names = names_of_images;
  std::sort(names.begin(), names.end());
  if (!names.empty() && names.front().empty()) return "one without a name";
  const bool is_twice = std::adjacent_find(names.begin(), names.end()) != names.end();
  return is_twice ? "two of one name" : "";
}

std::string broken_rule(const BlockFacts& block, std::size_t band_count) {
  if (block.band > band_count) return "there is no such band";
  const float most = format::error_of_code(format::kMaxErrorCode);
  if (!are_errors(block.coarse, most) || !are_errors(block.fine, most)) {
    return "an error is no finite number from 0 on";
  }
  if (any_greater(block.fine, block.coarse)) return "its fine end has the greater error";
  return {};
}

std::string broken_rule(BlockId id, std::span<const BlockId> dependencies) {
  for (std::size_t i = 0; i < dependencies.size(); ++i) {
    if (dependencies[i] >= id) return "it needs a block that is not before it";
    if (i > 0 && dependencies[i] <= dependencies[i - 1]) return "what it needs does not ascend";
  }
  return {};
}

}  // namespace crease

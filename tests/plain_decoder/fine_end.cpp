// docs/format-block.md, "Fine end": what triangles are there. Layers are in layers.cpp.
#include "plain_decoder/block_decoder.h"

namespace plain {

// Categories.
void read_categories(RangeDecoder& in, BlockState& block) {
  const Surface& surface = block.surface;
  std::vector<Category>& categories = block.end.categories;
  categories.resize(surface.triangles.size());
  const std::uint32_t materials = block.schema.materials, parts = block.schema.parts;
  if (materials < 2 && parts < 2) return;
  BitsBy<1> is_expected_part;
  BitsBy<2> is_expected_material;
  Tree other_material;
  Category last;
  for (std::uint32_t t = block.coarse_triangles; t < surface.triangles.size(); ++t) {
    const Numbers before = surface.neighbours_before(t);
    const bool alone = before.empty();
    const Category expected =
        alone ? last : categories[*std::min_element(before.begin(), before.end())];
    Category& category = categories[t];
    category.part = is_expected_part[{alone}].read(in) ? expected.part : in.index(parts);
    std::size_t agreement = std::min<std::size_t>(before.size(), 2);
    for (const std::uint32_t other : before) {
      if (categories[other].material != expected.material) agreement = 3;
    }
    const std::size_t which = std::min<std::size_t>(expected.material, 7);
    if (is_expected_material[{which, agreement}].read(in)) {
      category.material = expected.material;
    } else {
      category.material = materials <= 64 ? other_material.read(in) : in.index(materials);
      demand(category.material < materials, "a material that there is none of");
    }
    last = category;
  }
}

// Derived triangles.
void read_derived(RangeDecoder& in, BlockState& block) {
  const std::size_t triangles = block.surface.triangles.size();
  block.end.derived.assign(triangles, false);
  AdaptiveBit any;
  if (!any.read(in)) return;
  BitsBy<1> is_derived;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const bool is_new = block.is_new(t);
    if (is_new || block.was_derived[t]) block.end.derived[t] = is_derived[{is_new}].read(in);
  }
}

// Labels.

namespace {

using Place = std::array<double, 3>;

struct Box {
  std::uint32_t label = 0;
  Place low{}, high{};

  double away(const Place& place) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += std::max({0.0, low[k] - place[k], place[k] - high[k]});
    }
    return sum;
  }
  void take(const Place& place) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], place[k]);
      high[k] = std::max(high[k], place[k]);
    }
  }
};

Place place_of(const Surface& surface, std::uint32_t t) {
  Place place{};
  for (const std::uint32_t v : surface.triangles[t]) {
    for (std::size_t k = 0; k < 3; ++k) place[k] += surface.places[v].along(k);
  }
  return place;
}

const Box* nearest_box(const std::vector<Box>& boxes, const Place& place) {
  const Box* nearest = nullptr;
  for (const Box& box : boxes) {
    if (!nearest || box.away(place) < nearest->away(place)) nearest = &box;
  }
  return nearest;
}

void put_in_box(std::vector<Box>& boxes, std::uint32_t label, const Place& place) {
  for (Box& box : boxes) {
    if (box.label == label) return box.take(place);
  }
  if (boxes.size() < kLongest) boxes.push_back({label, place, place});
}

}  // namespace

void read_labels(RangeDecoder& in, BlockState& block) {
  const Surface& surface = block.surface;
  std::vector<std::uint32_t>& labels = block.end.labels;
  AdaptiveBit is_any_above_0;
  if (!is_any_above_0.read(in)) {
    labels.assign(surface.triangles.size(), 0);
    return;
  }
  std::vector<Box> boxes;
  BitsBy<2> is_box_label;
  AdaptiveBit is_other_label;
  Magnitude any_label;
  std::vector<std::optional<std::uint32_t>> last_at(surface.places.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const Place place = place_of(surface, t);
    std::optional<std::uint32_t> label, of_other;
    if (const Box* box = nearest_box(boxes, place)) {
      std::size_t agreement = 0;
      for (const std::uint32_t v : surface.triangles[t]) {
        if (!last_at[v]) continue;
        if (*last_at[v] == box->label) {
          agreement = std::max<std::size_t>(agreement, 1);
        } else {
          agreement = 2;
          of_other = last_at[v];
        }
      }
      if (is_box_label[{box->away(place) > 0, agreement}].read(in)) label = box->label;
    }
    if (!label && of_other && is_other_label.read(in)) label = of_other;
    if (!label) label = any_label.read(in);
    labels.push_back(*label);
    for (const std::uint32_t v : surface.triangles[t]) last_at[v] = label;
    put_in_box(boxes, *label, place);
  }
}

}  // namespace plain

#include "pipeline/snap_attributes.h"

#include "base/assert.h"
#include "mesh/corners_around.h"
#include "mesh/disjoint_sets.h"
#include "mesh/weld.h"
#include "pipeline/fit_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace crease {

namespace {

using Value = std::array<float, 4>;  // as much of it as the layer has components

Value value_at(std::span<const float> values, std::size_t i, std::size_t dimension) {
  Value value{};
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * dimension), dimension,
              value.begin());
  return value;
}

// Degrees between directions, else the distance.
double difference(const Value& a, const Value& b, bool directions) {
  if (directions) {
    const Vec3d u{a[0], a[1], a[2]}, v{b[0], b[1], b[2]};
    return degrees(std::atan2(length(cross(u, v)), dot(u, v)));
  }
  double squared = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double d = double(a[k]) - double(b[k]);
    squared += d * d;
  }
  return std::sqrt(squared);
}

bool holds_directions(const LayerCoding& coding) {
  return coding.kind == LayerCoding::Kind::Octahedral || coding.kind == LayerCoding::Kind::Sextant;
}

// Snaps each value and tells how far it moved.
template <typename Moved>  // Moved: moved(value index, how far)
void snap_values(std::span<float> values, std::size_t dimension, const LayerCoding& coding,
                 Moved moved) {
  const LayerQuantizer quantizer(coding);
  for (std::size_t i = 0; i * dimension < values.size(); ++i) {
    const Value before = value_at(values, i, dimension);
    quantizer.snap(values.subspan(i * dimension, dimension));
    moved(i, difference(before, value_at(values, i, dimension), holds_directions(coding)));
  }
}

// Values that meet at a vertex and are equal become one. Returns how many vanished.
std::size_t join_equal_values(AttributeLayer& layer, const CornersAround& around,
                              std::size_t vertex_count) {
  DisjointSets sets(layer.value_count());
  std::vector<std::uint32_t> ids;  // of the values at one vertex
  for (std::size_t v = 0; v < vertex_count; ++v) {
    ids.clear();
    for (std::uint32_t corner : around.of(v)) {
      const auto id = static_cast<std::uint32_t>(layer.of_corner[corner]);
      if (ids.empty() || ids.back() != id) ids.push_back(id);
    }
    if (ids.size() < 2) continue;
    const auto value = [&](std::uint32_t id) { return layer.value(AttributeId{id}); };
    std::sort(ids.begin(), ids.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::ranges::lexicographical_compare(value(a), value(b));
    });
    for (std::size_t i = 1; i < ids.size(); ++i) {
      if (std::ranges::equal(value(ids[i - 1]), value(ids[i]))) sets.unite(ids[i - 1], ids[i]);
    }
  }

  std::vector<std::uint32_t> kept, new_of_old(layer.value_count());
  for (std::uint32_t id = 0; id < new_of_old.size(); ++id) {
    const std::uint32_t first = sets.find(id);  // the smallest of its set: numbered already
    new_of_old[id] = first == id ? static_cast<std::uint32_t>(kept.size()) : new_of_old[first];
    if (first == id) kept.push_back(id);
  }
  const std::size_t joined = layer.value_count() - kept.size();
  if (joined == 0) return 0;
  keep_rows(layer.values, kept, layer.dimension);
  for (AttributeId& a : layer.of_corner) a = AttributeId{new_of_old[index_of(a)]};
  return joined;
}

std::string in_words(const LayerCoding& coding) {
  switch (coding.kind) {
    case LayerCoding::Kind::Exact:
      return "exact";
    case LayerCoding::Kind::Octahedral:
      return "octahedral, " + std::to_string(coding.bits) + " bits a component";
    case LayerCoding::Kind::Sextant:
      return "Deering, " + std::to_string(coding.bits) + " bits an angle";
    case LayerCoding::Kind::Lattice:
      break;
  }
  std::string words;
  for (const NumberLattice& lattice : coding.components) {
    char text[48];
    const double steps = double(lattice.divisor) / double(lattice.grain);  // a unit
    if (!lattice.palette.empty()) {
      std::snprintf(text, sizeof text, "%zu values", lattice.palette.size());
    } else if (steps >= 1) {
      std::snprintf(text, sizeof text, "steps of 1/%g", steps);
    } else {
      std::snprintf(text, sizeof text, "steps of %g", 1 / steps);
    }
    if (words.ends_with(text)) continue;
    words += (words.empty() ? "" : ", ") + std::string(text);
  }
  return words;
}

// Texture coordinates: a quarter of the steps asked for is what is left of their waver, and finer
// ones cost more than they gain. Colours: bytes, whose range is seldom whole, are fine enough.
int blend_bits(AttributeRole role, int bits) {
  return role == AttributeRole::TexCoord ? bits - 2 : std::min(bits, 7);
}

// What is asked for is of one texture. Where it repeats, a quarter of those steps a texture is the
// least, so that its texels lie still: a house of 80 repeats was off by two of 1024. A float has 24
// bits in all.
int bits_over_range(AttributeRole role, std::span<const float> values, int bits) {
  if (role != AttributeRole::TexCoord || values.empty()) return bits;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  int repeats = 0;  // in [2^(repeats - 1), 2^repeats)
  std::frexp(double(*high) - double(*low), &repeats);
  return bits + std::clamp(repeats - 2, 0, std::max(0, kMaxLatticeBits - bits));
}

LayerCoding lattice_coding(const AttributeLayer& layer, int bits) {
  LayerCoding coding{.kind = LayerCoding::Kind::Lattice, .bits = bits, .components = {}};
  std::vector<float> component(layer.value_count());
  for (std::size_t k = 0; k < layer.dimension; ++k) {
    for (std::size_t i = 0; i < component.size(); ++i) {
      component[i] = layer.values[i * layer.dimension + k];
    }
    const int steps = bits_over_range(layer.role, component, bits);
    coding.components.push_back(fit_lattice(component, steps, blend_bits(layer.role, steps)));
  }
  return coding;
}

LayerCoding coding_of(const AttributeLayer& layer, const AttributePrecision& precision) {
  if (layer.role == AttributeRole::Normal && precision.normal_bits != kExactBits) {
    const bool octahedral = precision.normal_coding == NormalCoding::Octahedral;
    return {.kind = octahedral ? LayerCoding::Kind::Octahedral : LayerCoding::Kind::Sextant,
            .bits = precision.normal_bits,
            .components = {}};
  }
  const int bits = layer.interpolation != Interpolation::Linear ? kExactBits
                   : layer.role == AttributeRole::TexCoord      ? precision.texcoord_bits
                   : layer.role == AttributeRole::Color         ? precision.color_bits
                                                                : kExactBits;
  return bits == kExactBits ? LayerCoding{} : lattice_coding(layer, bits);
}

}  // namespace

Status check_attribute_precision(const AttributePrecision& precision) {
  const bool octahedral = precision.normal_coding == NormalCoding::Octahedral;
  struct Range {
    const char* name;
    int bits, low, high;
  };
  for (const Range& range :
       {Range{"normal_bits", precision.normal_bits, octahedral ? 8 : 4, octahedral ? 16 : 12},
        Range{"texcoord_bits", precision.texcoord_bits, 4, kMaxAskedBits},
        Range{"color_bits", precision.color_bits, 4, kMaxAskedBits}}) {
    if (range.bits == kExactBits || (range.bits >= range.low && range.bits <= range.high)) continue;
    return fail(Error::BadValue, std::string(range.name) + " of " + std::to_string(range.bits) +
                                     ": " + std::to_string(range.low) + " to " +
                                     std::to_string(range.high) + ", or 0 for exact values");
  }
  return Done{};
}

std::vector<LayerCoding> codings_of(const Mesh& mesh, const AttributePrecision& precision) {
  std::vector<LayerCoding> codings;
  for (const AttributeLayer& layer : mesh.layers) codings.push_back(coding_of(layer, precision));
  return codings;
}

std::vector<SnappedLayer> snap_to_codings(Mesh& mesh, std::span<const LayerCoding> codings) {
  CREASE_ASSERT(codings.size() == mesh.layers.size());
  std::vector<SnappedLayer> reports;
  std::optional<CornersAround> around;
  for (std::size_t l = 0; l < codings.size(); ++l) {
    AttributeLayer& layer = mesh.layers[l];
    SnappedLayer& report = reports.emplace_back();
    report.layer = layer.name;
    report.precision = in_words(codings[l]);
    if (layer.values.empty()) continue;
    double sum = 0;
    if (codings[l].kind != LayerCoding::Kind::Exact) {
      snap_values(layer.values, layer.dimension, codings[l], [&](std::size_t, double distance) {
        report.error_max = std::max(report.error_max, distance);
        sum += distance;
      });
    }
    report.error_mean = sum / static_cast<double>(layer.value_count());
    if (!around) around.emplace(mesh);
    report.joined = join_equal_values(layer, *around, mesh.vertex_count());
  }
  return reports;
}

std::vector<SnappedLayer> snap_attributes(Mesh& mesh, const AttributePrecision& precision) {
  return snap_to_codings(mesh, codings_of(mesh, precision));
}

void snap_new_values(ContractionSequence& sequence, const Mesh& snapped,
                     std::span<const LayerCoding> codings) {
  CREASE_ASSERT(codings.size() == snapped.layers.size());
  std::vector<std::vector<float>> moved(sequence.new_values.size());  // by layer and new value
  for (std::size_t l = 0; l < moved.size(); ++l) {
    if (codings[l].kind == LayerCoding::Kind::Exact) continue;
    const std::size_t dimension = snapped.layers[l].dimension;
    moved[l].resize(sequence.new_values[l].size() / dimension);
    snap_values(sequence.new_values[l], dimension, codings[l], [&](std::size_t i, double distance) {
      moved[l][i] = static_cast<float>(distance);
    });
  }

  // What a vertex has shown since its leaves stays part of its error, so errors never fall.
  struct Moved {
    float degrees = 0, texture = 0;
  };
  std::vector<Moved> at_vertex(snapped.vertex_count());
  for (Contraction& c : sequence.contractions) {
    Moved& own = at_vertex[index_of(c.kept)];
    const Moved& other = at_vertex[index_of(c.removed)];
    own = {std::max(own.degrees, other.degrees), std::max(own.texture, other.texture)};
    for (const AttributeChange& change : sequence.changes_of(c)) {
      const AttributeLayer& layer = snapped.layers[change.layer];
      const std::size_t id = index_of(change.to);
      if (id < layer.value_count() || moved[change.layer].empty()) continue;
      const float distance = moved[change.layer][id - layer.value_count()];
      if (layer.role == AttributeRole::Normal) own.degrees = std::max(own.degrees, distance);
      if (layer.role == AttributeRole::TexCoord) own.texture = std::max(own.texture, distance);
    }
    c.error.degrees = std::min(180.0f, c.error.degrees + own.degrees);
    c.error.texture += own.texture;
  }
}

}  // namespace crease

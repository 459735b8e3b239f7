#include "io/raw_mesh.h"
#include "mesh/clean.h"
#include "mesh/guess_up.h"
#include "mesh/normals.h"
#include "mesh/strays.h"
#include "mesh/weld.h"
#include "mesh/weld_borders.h"

#include "base/assert.h"
#include "io/formats.h"
#include "io/images.h"
#include "io/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace crease {

namespace {

// Unit within this: left as it is, bit for bit.
constexpr double kUnitTolerance = 1e-3;

std::string in_degrees(double angle) {
  char text[32];
  std::snprintf(text, sizeof text, "%g degrees", angle);
  return text;
}

// Values that are not finite become zero. Returns how many values had any.
std::size_t clear_bad_values(RawLayer& layer) {
  std::size_t bad = 0;
  for (std::size_t i = 0; i < layer.value_count(); ++i) {
    bool is_bad = false;
    for (std::size_t k = 0; k < layer.dimension; ++k) {
      float& x = layer.values[i * layer.dimension + k];
      if (std::isfinite(x)) continue;
      x = 0;
      is_bad = true;
    }
    bad += is_bad;
  }
  return bad;
}

// From values per stored vertex, face or corner to values per corner.
AttributeLayer by_corner(RawLayer layer, const RawMesh& raw) {
  AttributeLayer out{std::move(layer.name),   layer.role, layer.interpolation, layer.dimension,
                     std::move(layer.values), {}};
  out.of_corner.reserve(3 * raw.triangles.size());
  switch (layer.per) {
    case RawLayer::Per::Corner:
      for (std::uint32_t i : layer.of_corner) out.of_corner.push_back(AttributeId{i});
      break;
    case RawLayer::Per::Vertex:
      for (const auto& triangle : raw.triangles) {
        for (std::uint32_t v : triangle) out.of_corner.push_back(AttributeId{v});
      }
      break;
    case RawLayer::Per::Face:
      for (std::uint32_t t = 0; t < raw.triangles.size(); ++t) {
        const std::uint32_t f = raw.face_of_triangle.empty() ? t : raw.face_of_triangle[t];
        out.of_corner.insert(out.of_corner.end(), 3, AttributeId{f});
      }
      break;
  }
  CREASE_ASSERT(out.of_corner.size() == 3 * raw.triangles.size());
  return out;
}

// Corners that have no value get zero. Returns how many there were.
std::size_t fill_with_zero(AttributeLayer& layer) {
  const AttributeId zero{static_cast<std::uint32_t>(layer.value_count())};
  std::size_t filled = 0;
  for (AttributeId& a : layer.of_corner) {
    if (a != kNoAttribute) continue;
    a = zero;
    ++filled;
  }
  if (filled > 0) layer.values.resize(layer.values.size() + layer.dimension, 0.0f);
  return filled;
}

// Unit length where it is not; a corner whose normal has no length loses it. Returns the number of
// such values in use.
std::size_t normalize_given(AttributeLayer& normals) {
  std::vector<bool> is_zero(normals.value_count(), false);
  for (std::size_t i = 0; i < is_zero.size(); ++i) {
    float* v = &normals.values[3 * i];
    const Vec3d n{v[0], v[1], v[2]};
    const double l = length(n);
    if (std::abs(l - 1) <= kUnitTolerance) continue;
    is_zero[i] = !(l > 1e-30);
    if (is_zero[i]) continue;
    for (int k = 0; k < 3; ++k) v[k] = static_cast<float>(n[k] / l);
  }
  std::vector<bool> is_counted(is_zero.size(), false);
  std::size_t zero_count = 0;
  for (AttributeId& a : normals.of_corner) {
    if (a == kNoAttribute || !is_zero[index_of(a)]) continue;
    if (!is_counted[index_of(a)]) ++zero_count;
    is_counted[index_of(a)] = true;
    a = kNoAttribute;
  }
  return zero_count;
}

// How normals are made, as edges and in words.
struct NormalRule {
  SoftEdges soft;
  std::string words;
  std::optional<NormalPolicy> policy;  // none: smoothing groups
};

// Where sharp edges are fragments, as the noise of a scan makes them, none of them is a feature.
constexpr double kMostLooseCreases = 0.2;     // hard surfaces have 0.08 at most, scans 0.25 to 0.6
constexpr std::size_t kScanTriangles = 2000;  // fewer say nothing about noise

bool is_scan(const Mesh& mesh, double angle_deg) {
  return mesh.triangle_count() >= kScanTriangles &&
         loose_crease_share(mesh, angle_deg) > kMostLooseCreases;
}

NormalRule rule_of(const NormalPolicy& asked, const RawMesh& raw, const Mesh& mesh) {
  NormalRule rule;
  rule.soft.face_of_triangle = raw.face_of_triangle;
  NormalPolicy policy = asked;
  if (policy.kind == NormalPolicy::Kind::Keep) {
    if (!raw.smoothing_group.empty()) {
      rule.soft.smoothing_group = raw.smoothing_group;
      rule.words = "smoothing groups";
      return rule;
    }
    policy = raw.default_normals;
    if (policy.kind == NormalPolicy::Kind::Crease && is_scan(mesh, policy.crease_angle_deg)) {
      rule.soft.max_angle_deg = 180;
      rule.policy = {.kind = NormalPolicy::Kind::Smooth};
      rule.words =
          "smooth (a scan: edges over " + in_degrees(policy.crease_angle_deg) + " are fragments)";
      return rule;
    }
  }
  rule.policy = policy;
  if (policy.kind == NormalPolicy::Kind::Keep) rule.policy->kind = NormalPolicy::Kind::Flat;
  switch (policy.kind) {
    case NormalPolicy::Kind::Keep:
    case NormalPolicy::Kind::Flat:
      rule.soft.max_angle_deg = kCoplanarDeg;
      rule.words = "flat";
      break;
    case NormalPolicy::Kind::Smooth:
      rule.soft.max_angle_deg = 180;
      rule.words = "smooth";
      break;
    case NormalPolicy::Kind::Crease:
      rule.soft.max_angle_deg = policy.crease_angle_deg;
      rule.words = "hard edges where the angle is over " + in_degrees(policy.crease_angle_deg);
      break;
  }
  return rule;
}

// The mesh's normal layer becomes the first and has a unit value at every corner.
void settle_normals(Mesh& mesh, const RawMesh& raw, const ImportOptions& options,
                    ImportReport& report) {
  const auto given = std::find_if(mesh.layers.begin(), mesh.layers.end(), [](const auto& layer) {
    return layer.role == AttributeRole::Normal;
  });
  const bool had_normals = given != mesh.layers.end();
  AttributeLayer normals;
  if (had_normals) {
    normals = std::move(*given);
    mesh.layers.erase(given);
    report.zero_normals = normalize_given(normals);
  }
  const auto is_given = [](AttributeId a) { return a != kNoAttribute; };
  const bool any_given = std::any_of(normals.of_corner.begin(), normals.of_corner.end(), is_given);
  const bool all_given = std::all_of(normals.of_corner.begin(), normals.of_corner.end(), is_given);
  const bool asked_for_new = options.normals.kind != NormalPolicy::Kind::Keep;
  const NormalRule rule =
      any_given && all_given && !asked_for_new ? NormalRule{} : rule_of(options.normals, raw, mesh);
  if (any_given && !asked_for_new) {
    report.reversed_normals = count_reversed_normals(mesh, normals);
    const std::size_t missing = complete_normals(normals, mesh, rule.soft);
    report.normals = "the file's";
    if (missing > 0) {
      report.normals += ", at " + std::to_string(missing) + " corners without: " + rule.words;
    }
    weld_layer(normals);
  } else {
    normals = generate_normals(mesh, rule.soft);
    report.made_normals = rule.policy;
    report.normals = rule.words + (asked_for_new ? ", as asked for" : ", as the file has none");
  }
  if (options.same_normal_deg > 0) {
    report.joined_normals = join_normals(normals, mesh, options.same_normal_deg);
  }
  mesh.layers.insert(mesh.layers.begin(), std::move(normals));
}

// Parts that a triangle names, in their old order.
void drop_unused_parts(Mesh& mesh) {
  std::vector<bool> used(mesh.parts.size(), false);
  for (PartId p : mesh.part_of_triangle) used[index_of(p)] = true;
  const std::vector<std::uint32_t> kept = kept_rows(used);
  if (kept.size() == mesh.parts.size()) return;
  std::vector<std::uint32_t> new_of_old(mesh.parts.size(), kNone);
  std::vector<std::string> parts;
  for (std::uint32_t old : kept) {
    new_of_old[old] = static_cast<std::uint32_t>(parts.size());
    parts.push_back(std::move(mesh.parts[old]));
  }
  mesh.parts = std::move(parts);
  for (PartId& p : mesh.part_of_triangle) p = PartId{new_of_old[index_of(p)]};
}

// Files say so of glass, and of everything where they mean the opposite.
void note_invisible(const Mesh& mesh, ImportReport& report) {
  std::vector<bool> is_invisible(mesh.materials.size(), false);
  for (MaterialId m : mesh.material_of_triangle) {
    is_invisible[index_of(m)] = mesh.materials[index_of(m)].base_color[3] <= 0;
  }
  note_materials(mesh.materials, is_invisible, "fully transparent", report.notes);
}

bool goes_on(const ImportOptions& options, const char* stage, double done) {
  return !options.progress || options.progress(stage, done);
}

void weld_vertices(RawMesh& raw, ImportReport& report) {
  const Weld weld = weld_positions(raw.positions);
  report.welded_vertices = raw.positions.size() - weld.first_old.size();
  if (weld.changes_nothing()) return;
  keep_rows(raw.positions, weld.first_old);
  for (auto& triangle : raw.triangles) {
    for (std::uint32_t& v : triangle) v = weld.new_of_old[v];
  }
}

double longest_side(const std::vector<Vec3d>& positions) {
  Vec3d low = positions.front(), high = low;
  for (const Vec3d& p : positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

std::string shortest(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

// Where many vertices are at borders that nearly meet, a note says which grid would join them.
void weld_rounded(Mesh& mesh, const std::optional<Precision>& precision, ImportReport& report) {
  const double asked = precision ? make_grid(mesh, *precision).step : rounding_of(mesh);
  const NearBorders near = find_near_borders(mesh, asked);
  report.welded_vertices += weld_borders(mesh, near);
  if (4 * (near.border_count - near.count) < mesh.vertex_count()) return;
  const auto joined_by = [&](double step) { return find_near_borders(mesh, step).count; };
  const double longest = longest_without_strays(mesh);
  double step = std::ldexp(longest, -16);
  const std::size_t count = joined_by(step);
  if (count == 0 || 8 * count < mesh.vertex_count()) return;
  while (step > std::ldexp(longest, -22) && 10 * joined_by(step / 4) > 9 * count) step /= 4;
  report.notes.push_back(std::to_string(count) + " of " + std::to_string(mesh.vertex_count()) +
                         " vertices are at open borders within " + shortest(step) +
                         " of another: its triangles are loose; --precision " + shortest(step) +
                         " joins them");
}

void drop_degenerate(Mesh& mesh, RawMesh& raw, ImportReport& report) {
  const std::vector<bool> keep = proper_triangles(mesh);
  const auto dropped = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), false));
  if (dropped == 0) return;
  report.degenerate_triangles += dropped;
  keep_triangles(mesh, keep);
  const std::vector<std::uint32_t> kept = kept_rows(keep);
  if (!raw.face_of_triangle.empty()) keep_rows(raw.face_of_triangle, kept);
  if (!raw.smoothing_group.empty()) keep_rows(raw.smoothing_group, kept);
}

}  // namespace

void Rounded::tell(const std::string& layer, std::vector<std::string>& notes) const {
  if (count == 0) return;
  notes.push_back(std::to_string(count) + " values of '" + layer + "' rounded to floats, by " +
                  shortest(most) + " at most");
}

void note_materials(std::span<const Material> materials, const std::vector<bool>& which,
                    const std::string& what, std::vector<std::string>& notes) {
  const auto count = std::ranges::count(which, true);
  if (count == 0) return;
  const auto first = std::ranges::find(which, true) - which.begin();
  notes.push_back(std::to_string(count) + (count == 1 ? " material is " : " materials are ") +
                  what + " (" + in_quotes(materials[static_cast<std::size_t>(first)].name) +
                  (count > 1 ? ", ...)" : ")"));
}

Result<Imported> finish_import(RawMesh raw, const ImportOptions& options, const std::string& name) {
  Imported imported;
  Mesh& mesh = imported.mesh;
  ImportReport& report = imported.report;
  report = std::move(raw.report);
  const auto interrupted = [&] { return fail(Error::Interrupted, name + ": interrupted"); };

  if (!goes_on(options, "weld", 0)) return interrupted();
  for (const Vec3d& p : raw.positions) {
    if (!is_position(p)) return fail(Error::BadValue, name + ": a position is " + fault_of(p));
  }
  for (RawLayer& layer : raw.layers) {
    if (const std::size_t bad = clear_bad_values(layer)) {
      report.bad_attribute_values += bad;
      report.notes.push_back("'" + layer.name + "' has " + std::to_string(bad) +
                             (bad == 1 ? " value that is" : " values that are") +
                             " not finite: set to zero");
    }
    mesh.layers.push_back(by_corner(std::move(layer), raw));
  }
  weld_vertices(raw, report);
  mesh.positions = std::move(raw.positions);
  mesh.triangles.reserve(raw.triangles.size());
  for (const auto& [a, b, c] : raw.triangles) {
    mesh.triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
  }
  raw.triangles = {};
  mesh.material_of_triangle = std::move(raw.material_of_triangle);
  mesh.part_of_triangle = std::move(raw.part_of_triangle);
  mesh.materials = std::move(raw.materials);
  mesh.parts = std::move(raw.parts);
  mesh.images = std::move(raw.images);
  settle_images(mesh.materials, mesh.images);

  drop_degenerate(mesh, raw, report);
  if (mesh.triangles.empty()) {
    std::string reason = "no triangles in it";
    if (report.degenerate_triangles > 0) {
      reason +=
          "; " + std::to_string(report.degenerate_triangles) + " with two equal corners dropped";
    }
    for (const std::string& note : report.notes) reason += "; " + note;
    return fail(Error::NoTriangles, name + ": " + reason);
  }
  report.isolated_vertices = drop_isolated_vertices(mesh);
  const double extent = longest_side(mesh.positions);
  if (extent < kMinExtent) {
    return fail(Error::BadValue, name + ": its longest side is " + shortest(extent) +
                                     ", which leaves no numbers to work with: scale it up");
  }
  if (extent < kLeastSeen || extent > kMostSeen) {
    report.notes.push_back("its longest side is " + shortest(extent) +
                           ": views of a camera tell errors of models between 1e-20 and 1e18 "
                           "alone, and stay coarse; scale it");
  }
  weld_rounded(mesh, options.precision, report);
  drop_degenerate(mesh, raw, report);
  drop_unused_parts(mesh);
  note_invisible(mesh, report);
  report.duplicate_triangles = count_duplicate_triangles(mesh);
  report.zero_area_triangles = count_zero_area_triangles(mesh);
  report.misoriented_edges = count_misoriented_edges(mesh);

  for (AttributeLayer& layer : mesh.layers) {
    if (layer.role == AttributeRole::Normal) continue;
    if (const std::size_t filled = fill_with_zero(layer); filled > 0) {
      report.notes.push_back(std::to_string(filled) + " corners without a value in '" + layer.name +
                             "': zero");
    }
    weld_layer(layer);
  }
  if (!goes_on(options, "normals", 0)) return interrupted();
  settle_normals(mesh, raw, options, report);
  report.up_is_guessed = raw.up == UpAxis::Unknown;
  mesh.up = report.up_is_guessed ? guess_up(mesh, raw.usual_up) : raw.up;
  report.up = mesh.up;
  if (!goes_on(options, "normals", 1)) return interrupted();
  return imported;
}

}  // namespace crease

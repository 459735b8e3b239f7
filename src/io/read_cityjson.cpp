// CityJSON 1.0, 1.1, 2.0 and CityJSONSeq. Section numbers refer to the specification of 2.0.
//
// Of each city object the geometries of its highest level of detail are taken. A city object is a
// part. A surface's semantic type (else its object's type) is its material, and where a file has
// semantics at all, the layer "semantic_surface" holds the material's index as a category.
// Polygons are flat: each has one normal.
#include "io/formats.h"
#include "io/json.h"
#include "io/text.h"
#include "io/triangulate_polygon.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease {
namespace {

// Linear base colours of the types that cities are made of; others are grey.
constexpr std::array<std::pair<std::string_view, std::array<float, 4>>, 17> kColors = {{
    {"RoofSurface", {0.45f, 0.09f, 0.06f, 1}},
    {"OuterCeilingSurface", {0.45f, 0.40f, 0.34f, 1}},
    {"OuterFloorSurface", {0.38f, 0.34f, 0.30f, 1}},
    {"WallSurface", {0.72f, 0.66f, 0.54f, 1}},
    {"InteriorWallSurface", {0.80f, 0.78f, 0.72f, 1}},
    {"GroundSurface", {0.20f, 0.18f, 0.16f, 1}},
    {"FloorSurface", {0.35f, 0.30f, 0.25f, 1}},
    {"CeilingSurface", {0.70f, 0.70f, 0.68f, 1}},
    {"ClosureSurface", {0.60f, 0.60f, 0.60f, 1}},
    {"Window", {0.18f, 0.32f, 0.45f, 1}},
    {"Door", {0.22f, 0.12f, 0.06f, 1}},
    {"WaterSurface", {0.08f, 0.22f, 0.40f, 1}},
    {"WaterBody", {0.08f, 0.22f, 0.40f, 1}},
    {"PlantCover", {0.12f, 0.30f, 0.08f, 1}},
    {"SolitaryVegetationObject", {0.10f, 0.28f, 0.07f, 1}},
    {"Road", {0.12f, 0.12f, 0.13f, 1}},
    {"TINRelief", {0.30f, 0.28f, 0.18f, 1}},
}};

std::array<float, 4> color_of(const std::string& type) {
  const auto* found =
      std::ranges::find(kColors, type, [](const auto& entry) { return entry.first; });
  return found == kColors.end() ? std::array<float, 4>{0.6f, 0.6f, 0.6f, 1} : found->second;
}

// "2.2" or 2.2; geometries without one come last.
double lod_of(const Json& geometry) {
  const Json& lod = at(geometry, "lod");
  const auto* text = lod.get_ptr<const std::string*>();
  if (text == nullptr) return as_number(lod, -1);
  double level = 0;
  std::from_chars(text->data(), text->data() + text->size(), level);
  return level;
}

// 3.1: how deep the lists of surfaces lie in `boundaries`; -1 if the type has no surfaces.
int shell_depth(const std::string& type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 0;
  if (type == "Solid") return 1;
  if (type == "MultiSolid" || type == "CompositeSolid") return 2;
  return -1;
}

class CityBuilder {
 public:
  explicit CityBuilder(const Source& source) : source_(source) {
    raw_.default_normals = {NormalPolicy::Kind::Flat, 0};
  }

  // The first line or the whole file: transform and templates hold for all that follows.
  Status begin(const Json& json) {
    const std::string version = as_text(at(json, "version"));
    if (as_text(at(json, "type")) != "CityJSON") {
      const bool is_tileset = at(json, "root").is_object() && at(json, "asset").is_object();
      return fail_at_place(Error::BadFormat, source_, "type",
                           is_tileset ? "not \"CityJSON\": a tileset of 3D Tiles, which has no "
                                        "triangles itself; its tiles (.b3dm, .glb) have"
                                      : "not \"CityJSON\"");
    }
    if (version != "1.0" && version != "1.1" && version != "2.0" && !version.starts_with("1.0.") &&
        !version.starts_with("1.1.") && !version.starts_with("2.0.")) {
      return fail_at_place(Error::NotSupported, source_, "version",
                           in_quotes(version) + "; 1.0, 1.1 and 2.0 are read");
    }
    raw_.report.format = "CityJSON " + version;
    raw_.up = UpAxis::Z;
    const Json& transform = at(json, "transform");
    if (!transform.is_null()) {
      const auto scale = as_vector(at(transform, "scale"));
      const auto translate = as_vector(at(transform, "translate"));
      if (!scale || !translate) {
        return fail_at_place(Error::BadFormat, source_, "transform", "no scale and translate");
      }
      scale_ = *scale;
      translate_ = *translate;
    }
    templates_ = &at(at(json, "geometry-templates"), "templates");
    Status read =
        read_vertices(at(at(json, "geometry-templates"), "vertices-templates"),
                      "geometry-templates.vertices-templates", {1, 1, 1}, {}, template_vertices_);
    if (!read.ok()) return read;
    if (!at(json, "appearance").is_null()) {
      raw_.report.notes.push_back("appearance (textures and materials) ignored");
    }
    return Done{};
  }

  // A CityJSON object or a CityJSONFeature; `place` begins its messages: "" or "line 3: ".
  Status add(const Json& json, const std::string& place) {
    vertices_.clear();
    Status read =
        read_vertices(at(json, "vertices"), place + "vertices", scale_, translate_, vertices_);
    if (!read.ok()) return read;
    stored_.assign(vertices_.size(), kNone);
    const Json& objects = at(json, "CityObjects");
    if (!objects.is_object()) {
      return fail_at_place(Error::BadFormat, source_, place + "CityObjects", "missing");
    }
    for (const auto& [id, object] : objects.items()) {
      Status added = add_object(id, object, place + "CityObjects." + in_quotes(id));
      if (!added.ok()) return added;
    }
    return Done{};
  }

  RawMesh finish() {
    if (has_semantics_) {
      RawLayer layer;
      layer.name = "semantic_surface";
      layer.interpolation = Interpolation::Categorical;
      layer.per = RawLayer::Per::Face;
      layer.values = std::move(material_of_face_);
      raw_.layers.push_back(std::move(layer));
    }
    const auto note = [&](std::size_t count, const char* what) {
      if (count > 0) raw_.report.notes.push_back(std::to_string(count) + " " + what);
    };
    note(coarser_geometries_, "geometries of a lower level of detail than their object's highest");
    note(other_geometries_, "geometries of points or lines ignored");
    note(fanned_, "polygons that cross themselves or have no area, cut as fans");
    note(short_rings_, "rings of fewer than three corners ignored");
    note(objects_with_attributes_, "city objects' own attributes ignored");
    return std::move(raw_);
  }

 private:
  // Row-major 4 * 4, of a GeometryInstance; maps template vertices.
  struct Placement {
    std::array<double, 16> m;
    Vec3d reference;

    Vec3d point(const Vec3d& p) const {
      return Vec3d{m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3],
                   m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                   m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]} +
             reference;
    }
    bool mirrors() const {
      const Vec3d x{m[0], m[4], m[8]}, y{m[1], m[5], m[9]}, z{m[2], m[6], m[10]};
      return dot(cross(x, y), z) < 0;
    }
  };

  // What the surfaces of one geometry share.
  struct Context {
    const std::vector<Vec3d>& vertices;
    std::vector<std::uint32_t>& stored;  // per vertex: its index in raw_.positions, or kNone
    std::vector<std::uint32_t> material_of_semantic;
    std::uint32_t object_material = 0;
    PartId part{};
  };

  Status read_vertices(const Json& json, const std::string& place, const Vec3d& scale,
                       const Vec3d& translate, std::vector<Vec3d>& to) {
    to.reserve(size_of(json));
    for (std::size_t i = 0; i < size_of(json); ++i) {
      const auto v = as_vector(json[i]);
      if (!v) return fail_at_place(Error::BadFormat, source_, place_of(place, i), "not a vertex");
      const Vec3d p{v->x * scale.x + translate.x, v->y * scale.y + translate.y,
                    v->z * scale.z + translate.z};
      if (!is_position(p)) {
        return fail_at_place(Error::BadValue, source_, place_of(place, i),
                             std::string("position is ") + fault_of(p));
      }
      to.push_back(p);
    }
    return Done{};
  }

  Status add_object(const std::string& id, const Json& object, const std::string& place) {
    const Json& geometries = at(object, "geometry");
    const std::string type = as_text(at(object, "type"));
    if (!at(object, "attributes").empty()) ++objects_with_attributes_;
    double highest = -1;
    for (std::size_t g = 0; g < size_of(geometries); ++g) {
      highest = std::max(highest, lod_of_geometry(geometries[g]));
    }
    const auto part = static_cast<PartId>(raw_.parts.size());
    const std::size_t first_triangle = raw_.triangles.size();
    for (std::size_t g = 0; g < size_of(geometries); ++g) {
      if (lod_of_geometry(geometries[g]) < highest) {
        ++coarser_geometries_;
        continue;
      }
      const std::string here = place_of(place + ".geometry", g);
      Status added = as_text(at(geometries[g], "type")) == "GeometryInstance"
                         ? add_instance(geometries[g], type, part, here)
                         : add_geometry(geometries[g], type, part, here, vertices_, stored_);
      if (!added.ok()) return added;
    }
    if (raw_.triangles.size() > first_triangle) raw_.parts.push_back(id);
    return Done{};
  }

  const Json& template_of(const Json& instance) const {
    static const Json none;
    const auto index = as_index(at(instance, "template"));
    return index ? at(*templates_, *index) : none;
  }
  double lod_of_geometry(const Json& geometry) const {
    const bool is_instance = as_text(at(geometry, "type")) == "GeometryInstance";
    return lod_of(is_instance ? template_of(geometry) : geometry);
  }

  // 3.4: a template, transformed and put at one of the file's vertices.
  Status add_instance(const Json& instance, const std::string& object_type, PartId part,
                      const std::string& place) {
    const Json& geometry = template_of(instance);
    const Json& matrix = at(instance, "transformationMatrix");
    const auto reference = as_index(at(at(instance, "boundaries"), std::size_t(0)));
    if (geometry.is_null() || size_of(matrix) != 16 || !reference ||
        *reference >= vertices_.size()) {
      return fail_at_place(Error::BadValue, source_, place,
                           "no such template, vertex or transformationMatrix");
    }
    // Every instance copies the template's vertices, so a small file could ask for any memory.
    instanced_ += template_vertices_.size() + 1;
    if (instanced_ > limit()) {
      return fail_at_place(Error::OverLimit, source_, place,
                           "templates multiply the file beyond reason");
    }
    Placement placement{{}, vertices_[*reference]};
    for (std::size_t i = 0; i < 16; ++i) placement.m[i] = as_number(matrix[i], 0);
    std::vector<Vec3d> placed;
    placed.reserve(template_vertices_.size());
    for (const Vec3d& p : template_vertices_) placed.push_back(placement.point(p));
    std::vector<std::uint32_t> stored(placed.size(), kNone);
    const std::size_t first = raw_.triangles.size();
    const Status added = add_geometry(geometry, object_type, part, place, placed, stored);
    if (!placement.mirrors()) return added;
    for (std::size_t t = first; t < raw_.triangles.size(); ++t) {
      std::swap(raw_.triangles[t][1], raw_.triangles[t][2]);
    }
    return added;
  }

  Status add_geometry(const Json& geometry, const std::string& object_type, PartId part,
                      const std::string& place, const std::vector<Vec3d>& vertices,
                      std::vector<std::uint32_t>& stored) {
    const int depth = shell_depth(as_text(at(geometry, "type")));
    if (depth < 0) {
      ++other_geometries_;
      return Done{};
    }
    Context context{vertices, stored, {}, material_named(object_type), part};
    const Json& semantics = at(geometry, "semantics");
    const Json& surfaces = at(semantics, "surfaces");
    for (std::size_t i = 0; i < size_of(surfaces); ++i) {
      const std::string type = as_text(at(surfaces[i], "type"));
      context.material_of_semantic.push_back(type.empty() ? context.object_material
                                                          : material_named(type));
    }
    has_semantics_ |= size_of(surfaces) > 0;
    return add_surfaces(at(geometry, "boundaries"), at(semantics, "values"), depth, context,
                        place + ".boundaries");
  }

  // Goes down to the lists of surfaces; `values` has the same shape, or null anywhere.
  Status add_surfaces(const Json& boundaries, const Json& values, int depth, Context& context,
                      const std::string& place) {
    for (std::size_t i = 0; i < size_of(boundaries); ++i) {
      Status added = Done{};
      if (depth > 0) {
        added = add_surfaces(boundaries[i], at(values, i), depth - 1, context, place_of(place, i));
      } else {
        const auto semantic = as_index(at(values, i));
        const bool known = semantic && *semantic < context.material_of_semantic.size();
        added =
            add_surface(boundaries[i],
                        known ? context.material_of_semantic[*semantic] : context.object_material,
                        context, place, i);
      }
      if (!added.ok()) return added;
    }
    return Done{};
  }

  // One polygon: its outer ring, then its holes.
  Status add_surface(const Json& rings, std::uint32_t material, Context& context,
                     const std::string& place, std::size_t rank) {
    corners_.clear();
    points_.clear();
    hole_starts_.clear();
    for (std::size_t r = 0; r < size_of(rings); ++r) {
      const Json& ring = rings[r];
      if (size_of(ring) < 3) {
        ++short_rings_;
        if (r == 0) return Done{};
        continue;
      }
      if (r > 0) hole_starts_.push_back(static_cast<std::uint32_t>(points_.size()));
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto v = as_index(ring[i]);
        if (!v || *v >= context.vertices.size()) {
          const std::string here = place_of(place_of(place_of(place, rank), r), i);
          return fail_at_place(Error::BadValue, source_, here,
                               (v ? "index " + std::to_string(*v) : std::string("no index")) +
                                   " of " + std::to_string(context.vertices.size()) + " vertices");
        }
        corners_.push_back(*v);
        points_.push_back(context.vertices[*v]);
        if (!is_position(points_.back())) {
          return fail_at_place(Error::BadValue, source_, place_of(place, rank),
                               std::string("position is ") + fault_of(points_.back()));
        }
      }
    }
    if (corners_.empty()) return Done{};
    corners_used_ += corners_.size();
    if (corners_used_ > limit()) {
      return fail_at_place(Error::OverLimit, source_, place,
                           "templates multiply the file beyond reason");
    }
    const PolygonTriangles cut = triangulate_polygon(points_, hole_starts_);
    fanned_ += cut.fanned;
    if (corners_.size() > 3) ++raw_.report.polygons;
    const auto face = static_cast<std::uint32_t>(material_of_face_.size());
    material_of_face_.push_back(static_cast<float>(material));
    for (const auto& triangle : cut.triangles) {
      std::array<std::uint32_t, 3> stored;
      for (std::size_t c = 0; c < 3; ++c) stored[c] = store(context, corners_[triangle[c]]);
      raw_.triangles.push_back(stored);
      raw_.face_of_triangle.push_back(face);
      raw_.material_of_triangle.push_back(static_cast<MaterialId>(material));
      raw_.part_of_triangle.push_back(context.part);
    }
    return Done{};
  }

  std::uint32_t store(Context& context, std::size_t v) {
    if (context.stored[v] == kNone) {
      context.stored[v] = static_cast<std::uint32_t>(raw_.positions.size());
      raw_.positions.push_back(context.vertices[v]);
    }
    return context.stored[v];
  }

  std::uint32_t material_named(const std::string& type) {
    const std::string name = type.empty() ? "unknown" : type;
    const auto [found, is_new] =
        material_of_type_.try_emplace(name, static_cast<std::uint32_t>(raw_.materials.size()));
    if (is_new) raw_.materials.push_back({name, color_of(name), {}});
    return found->second;
  }

  // Without templates a corner takes two bytes of the file at least.
  std::size_t limit() const {
    return std::min<std::size_t>((std::size_t(1) << 20) + 1000 * source_.bytes.size(),
                                 std::size_t(1) << 29);
  }

  const Source& source_;
  RawMesh raw_;
  Vec3d scale_{1, 1, 1}, translate_;
  const Json* templates_ = nullptr;
  std::vector<Vec3d> vertices_, template_vertices_;
  std::vector<std::uint32_t> stored_;
  std::map<std::string, std::uint32_t> material_of_type_;
  std::vector<float> material_of_face_;
  bool has_semantics_ = false;
  std::size_t instanced_ = 0, corners_used_ = 0;
  std::size_t coarser_geometries_ = 0, other_geometries_ = 0, fanned_ = 0, short_rings_ = 0;
  std::size_t objects_with_attributes_ = 0;
  // Of the surface in work, kept for their memory.
  std::vector<std::size_t> corners_;
  std::vector<Vec3d> points_;
  std::vector<std::uint32_t> hole_starts_;
};

bool is_blank_text(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

}  // namespace

Result<RawMesh> read_cityjson(const Source& source) {
  const std::string_view text = source.text();
  const std::size_t first_end = std::min(text.find('\n'), text.size());
  const std::string_view first = text.substr(0, first_end);
  // CityJSONSeq: one JSON a line. A CityJSON over several lines has no whole JSON on its first one.
  const bool is_sequence =
      !is_blank_text(text.substr(first_end)) && Json::accept(first.begin(), first.end());
  const Result<Json> head = parse_json(source, is_sequence ? first : text, 0);
  if (!head.ok()) return head.failure();
  CityBuilder builder(source);
  if (Status begun = builder.begin(*head); !begun.ok()) return begun.failure();
  if (!is_sequence) {
    if (Status added = builder.add(*head, ""); !added.ok()) return added.failure();
    return builder.finish();
  }
  if (at(*head, "CityObjects").is_object()) {  // usually empty in a sequence
    if (Status added = builder.add(*head, "line 1: "); !added.ok()) return added.failure();
  }
  std::size_t line = 1;
  for (std::size_t begin = first_end + 1; begin < text.size();) {
    ++line;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view content = text.substr(begin, end - begin);
    if (!is_blank_text(content)) {
      const Result<Json> feature = parse_json(source, content, begin);
      if (!feature.ok()) return feature.failure();
      const std::string place = "line " + std::to_string(line) + ": ";
      if (Status added = builder.add(*feature, place); !added.ok()) return added.failure();
    }
    begin = end + 1;
  }
  return builder.finish();
}

}  // namespace crease

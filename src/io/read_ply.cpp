// PLY: text and both binary orders; vertices with normals, colours, texture coordinates and
// whatever else; faces with any number of corners, or triangle strips. Properties that have no
// place in a mesh become attribute layers under their own names.
#include "io/face_sink.h"
#include "io/formats.h"
#include "io/ply_body.h"
#include "io/ply_header.h"
#include "io/ply_indices.h"
#include "io/ply_layers.h"
#include "io/ply_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crease {

namespace {

std::string shown(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

class PlyReader {
 public:
  PlyReader(const Source& source, const PlyHeader& header)
      : source_(source), header_(header), body_(source, header), sink_(raw_) {}

  Result<RawMesh> read() {
    raw_.report.format = header_.encoding == PlyEncoding::Text           ? "text PLY"
                         : header_.encoding == PlyEncoding::LittleEndian ? "binary PLY"
                                                                         : "big-endian binary PLY";
    raw_.up = up_in(header_.comments);
    for (const std::string& word : header_.unknown_words) {
      raw_.report.notes.push_back("line of the header ignored that begins with " + in_quotes(word));
    }
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      if (!fits(element) || !read_element(element)) return *failure_;
    }
    if (body_.has_more_rows()) {
      raw_.report.notes.push_back(body_.is_text() ? "lines after the last row ignored"
                                                  : "bytes after the last row ignored");
    }
    finish();
    return std::move(raw_);
  }

 private:
  bool refuse(Failure failure) {
    failure_ = std::move(failure);
    return false;
  }

  // No memory is taken for rows that the file cannot hold.
  bool fits(const PlyElement& element) {
    // The last row of a text may lack its line end.
    const std::size_t left = body_.left() + (body_.is_text() ? 1 : 0);
    if (element.count <= left / element.least_bytes(body_.is_text()) && element.count < kNone) {
      return true;
    }
    return refuse(
        body_.refuse(Error::Truncated, "the header promises " + std::to_string(element.count) +
                                           " rows of '" + element.name + "', more than the " +
                                           std::to_string(left) + " bytes that are left can hold"));
  }

  bool read_element(const PlyElement& element) {
    if (element.name == "vertex") return read_vertices(element);
    const bool is_face = element.name == "face", is_strip = element.name == "tristrips";
    if ((is_face || is_strip) && element.count > 0 && is_before_vertices(element)) {
      return refuse(body_.refuse(Error::NotSupported,
                                 "'" + element.name + "' comes before the vertices it names"));
    }
    if (is_face) return read_faces(element);
    if (is_strip) return read_strips(element);
    if (element.name == "multi_texture_vertex" && uv_.empty() && find_scalar(element, "u") &&
        find_scalar(element, "v")) {
      return read_texture_vertices(element);
    }
    if (element.name == "multi_texture_face" && !uv_.empty() && uv_of_corner_.empty() &&
        every_face_is_a_triangle()) {
      return read_texture_faces(element);
    }
    raw_.report.notes.push_back("element '" + element.name + "' ignored");
    return skip_rows(element);
  }

  bool is_before_vertices(const PlyElement& element) const {
    return std::any_of(
        &element, header_.elements.data() + header_.elements.size(),
        [](const PlyElement& later) { return later.name == "vertex" && later.count > 0; });
  }

  template <typename TakeScalar, typename TakeList>
  bool read_row(const PlyElement& element, std::size_t i, TakeScalar take_scalar,
                TakeList take_list) {
    const auto what = [&] {
      return element.name + " " + std::to_string(i) + " of " + std::to_string(element.count);
    };
    if (!body_.begin_row()) return refuse(body_.problem(what()));
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      double x = 0;
      if (!body_.number(property.is_list ? property.count_type : property.type, x)) {
        return refuse(body_.problem(what()));
      }
      if (!property.is_list) {
        if (!take_scalar(p, x)) return false;
        continue;
      }
      // Even in text an item takes a digit, so no list is longer than the file has bytes.
      if (!(x >= 0) || x != std::floor(x)) {
        return refuse(body_.refuse(Error::BadValue, what() + ": a list of negative length"));
      }
      const auto size = static_cast<double>(source_.bytes.size());
      const auto left = static_cast<double>(body_.left());
      if (body_.is_text() ? x > size : x * static_cast<double>(size_of(property.type)) > left) {
        return refuse(body_.refuse(Error::Truncated, what() + ": a list longer than the file"));
      }
      list_.clear();
      for (double item; list_.size() < static_cast<std::size_t>(x); list_.push_back(item)) {
        if (!body_.number(property.type, item)) return refuse(body_.problem(what()));
      }
      if (!take_list(p)) return false;
    }
    if (body_.row_has_more()) ++rows_with_more_;
    if ((i & 0xffff) == 0xffff && source_.progress && *source_.progress &&
        !(*source_.progress)("read", 0.5)) {
      return refuse(body_.refuse(Error::Interrupted, "interrupted"));
    }
    return true;
  }

  bool skip_rows(const PlyElement& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!read_row(
              element, i, [](std::size_t, double) { return true; },
              [](std::size_t) { return true; })) {
        return false;
      }
    }
    rows_with_more_ = 0;  // all of them are ignored
    return true;
  }

  bool read_vertices(const PlyElement& element) {
    vertices_ = plan_layers(element, RawLayer::Per::Vertex, header_.comments, raw_.report.notes);
    for (std::string_view axis : {"x", "y", "z"}) {
      if (find_scalar(element, axis)) continue;
      return refuse(body_.refuse(Error::BadFormat, "vertices have no " + std::string(axis)));
    }
    raw_.positions.reserve(element.count);
    for (RawLayer& layer : vertices_.layers) layer.values.reserve(layer.dimension * element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3d position;
      const auto take = [&](std::size_t p, double x) {
        const PlyTarget& target = vertices_.targets[p];
        if (target.kind == PlyTarget::Kind::Position)
          position[static_cast<int>(target.component)] = x;
        if (target.kind == PlyTarget::Kind::Layer) vertices_.set(target, x);
        return true;
      };
      if (!read_row(element, i, take, [](std::size_t) { return true; })) return false;
      if (!is_position(position)) {
        return refuse(body_.refuse(Error::BadValue,
                                   "vertex " + std::to_string(i) + " is " + fault_of(position)));
      }
      raw_.positions.push_back(position);
      vertices_.keep_row();
    }
    if (note_long_rows(element)) vertices_.layers.clear();
    return true;
  }

  // A row that holds more numbers than the header says: which of them are meant is not known. What
  // comes before is kept: positions of vertices, corners of faces.
  bool note_long_rows(const PlyElement& element) {
    if (rows_with_more_ == 0) return false;
    raw_.report.notes.push_back(std::to_string(rows_with_more_) + " rows of '" + element.name +
                                "' hold more numbers than the header says: their other properties "
                                "are ignored");
    rows_with_more_ = 0;
    return true;
  }

  bool read_faces(const PlyElement& element) {
    faces_ = plan_layers(element, RawLayer::Per::Face, header_.comments, raw_.report.notes);
    const bool has_indices = std::any_of(
        faces_.targets.begin(), faces_.targets.end(),
        [](const PlyTarget& target) { return target.kind == PlyTarget::Kind::Indices; });
    if (!has_indices && element.count > 0) {
      return refuse(body_.refuse(Error::BadFormat, "faces have no vertex_indices"));
    }
    if (!faces_.layers.empty()) sink_.keep_faces();
    raw_.triangles.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      corners_.clear();
      corner_uv_.clear();
      const auto take = [&](std::size_t p, double x) {
        if (faces_.targets[p].kind == PlyTarget::Kind::Layer) faces_.set(faces_.targets[p], x);
        return true;
      };
      const auto take_list = [&](std::size_t p) {
        if (faces_.targets[p].kind == PlyTarget::Kind::CornerTexCoords) corner_uv_ = list_;
        return faces_.targets[p].kind != PlyTarget::Kind::Indices || take_corners();
      };
      if (!read_row(element, i, take, take_list)) return false;
      if (corners_.size() < 3) {
        ++short_faces_;
        continue;
      }
      sink_.add_face(corners_);
      faces_.keep_row();
      keep_corner_uv();
    }
    if (note_long_rows(element)) faces_.layers.clear();
    return true;
  }

  // Lists may be of floats.
  bool take_vertex(double item, std::uint32_t& vertex) {
    if (!(item >= 0) || item >= static_cast<double>(raw_.positions.size())) {
      return refuse(body_.refuse(Error::BadValue, "vertex index " + shown(item) + " of " +
                                                      std::to_string(raw_.positions.size()) +
                                                      " vertices"));
    }
    if (item != std::floor(item)) {
      return refuse(
          body_.refuse(Error::BadValue, "vertex index " + shown(item) + " is no whole number"));
    }
    vertex = static_cast<std::uint32_t>(item);
    return true;
  }

  bool take_corners() {
    for (double item : list_) {
      std::uint32_t vertex = 0;
      if (!take_vertex(item, vertex)) return false;
      corners_.push_back(vertex);
    }
    return true;
  }

  // Two numbers a corner; anything else is no texture coordinate.
  void keep_corner_uv() {
    const bool has = corner_uv_.size() == 2 * corners_.size();
    if (!has && uv_of_corner_.empty()) return;
    uv_of_corner_.resize(3 * (raw_.triangles.size() - sink_.cut().size()), kNone);
    const auto first = static_cast<std::uint32_t>(uv_.size() / 2);
    if (has) {
      for (double x : corner_uv_) uv_.push_back(static_cast<float>(x));
    }
    for (const auto& triangle : sink_.cut()) {
      for (std::uint32_t rank : triangle) uv_of_corner_.push_back(has ? first + rank : kNone);
    }
  }

  // Scanners' programs write texture coordinates as vertices of their own, and their corners, with
  // the texture's number, for each face `tn`.
  bool read_texture_vertices(const PlyElement& element) {
    const std::size_t u = *find_scalar(element, "u"), v = *find_scalar(element, "v");
    for (std::size_t i = 0; i < element.count; ++i) {
      std::array<float, 2> uv{};
      const auto take = [&](std::size_t p, double x) {
        if (p == u || p == v) uv[p == u ? 0 : 1] = static_cast<float>(x);
        return true;
      };
      if (!read_row(element, i, take, [](std::size_t) { return true; })) return false;
      uv_.insert(uv_.end(), uv.begin(), uv.end());
    }
    note_long_rows(element);
    return true;
  }

  bool every_face_is_a_triangle() const {
    return raw_.report.polygons == 0 && short_faces_ == 0 &&
           sink_.face_count() == raw_.triangles.size();
  }

  bool read_texture_faces(const PlyElement& element) {
    const auto number = find_scalar(element, "tn"), texture = find_scalar(element, "tx");
    uv_of_corner_.resize(3 * raw_.triangles.size(), kNone);
    texture_of_face_.resize(raw_.triangles.size());
    for (std::size_t i = 0; i < element.count; ++i) {
      auto face = static_cast<double>(i), of_face = 0.0;
      const auto take = [&](std::size_t p, double x) {
        if (p == number) face = x;
        if (p == texture) of_face = x;
        return true;
      };
      corner_uv_.clear();
      const auto take_list = [&](std::size_t p) {
        if (element.properties[p].name == "texture_vertex_indices") corner_uv_ = list_;
        return true;
      };
      if (!read_row(element, i, take, take_list)) return false;
      if (!(face >= 0 && face < static_cast<double>(raw_.triangles.size()))) continue;
      const auto triangle = static_cast<std::size_t>(face);
      texture_of_face_[triangle] = static_cast<float>(of_face);
      for (std::size_t c = 0; c < 3 && corner_uv_.size() == 3; ++c) {
        const double index = corner_uv_[c];
        if (!(index >= 0 && index < static_cast<double>(uv_.size() / 2))) continue;
        uv_of_corner_[3 * triangle + c] = static_cast<std::uint32_t>(index);
      }
    }
    note_long_rows(element);
    return true;
  }

  // Strips in one list, cut by -1.
  bool read_strips(const PlyElement& element) {
    const std::vector<PlyProperty>& properties = element.properties;
    if (std::none_of(properties.begin(), properties.end(), is_index_list) && element.count > 0) {
      return refuse(body_.refuse(Error::BadFormat, "strips have no vertex_indices"));
    }
    for (const PlyProperty& property : properties) {
      if (is_index_list(property)) continue;
      raw_.report.notes.push_back("'" + property.name + "' of '" + element.name + "' ignored");
    }
    const auto take_list = [&](std::size_t p) {
      return !is_index_list(properties[p]) || take_strips();
    };
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!read_row(
              element, i, [](std::size_t, double) { return true; }, take_list))
        return false;
    }
    note_long_rows(element);
    return true;
  }

  // Every other triangle of a strip is turned round.
  bool take_strips() {
    corners_.clear();
    for (double item : list_) {
      if (item == -1) {
        corners_.clear();
        continue;
      }
      std::uint32_t vertex = 0;
      if (!take_vertex(item, vertex)) return false;
      corners_.push_back(vertex);
      if (corners_.size() < 3) continue;
      const std::uint32_t* const last = &corners_.back() - 2;
      const bool is_turned = corners_.size() % 2 == 0;
      const std::array<std::uint32_t, 3> triangle{last[is_turned ? 1 : 0], last[is_turned ? 0 : 1],
                                                  last[2]};
      // Strips turn corners by repeating a vertex; that is no ugliness to be counted.
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        continue;
      }
      sink_.add_face(triangle);
    }
    return true;
  }

  static void tell_rounded(const PlyLayers& from, ImportReport& report) {
    for (std::size_t l = 0; l < from.layers.size(); ++l) {
      if (from.layers[l].role != AttributeRole::Other) continue;
      from.rounded[l].tell(from.layers[l].name, report.notes);
    }
  }

  void finish() {
    tell_rounded(vertices_, raw_.report);
    tell_rounded(faces_, raw_.report);
    // Vertices' normals and colours go before faces'. Faces that strips made have no values.
    for (std::size_t l = 0; l < vertices_.layers.size(); ++l) {
      RawLayer& layer = vertices_.layers[l];
      if (!vertices_.is_told[l]) {
        scale_float_colors(layer, raw_.report.notes);
        settle_categories(layer, raw_.report.notes);
      }
      raw_.layers.push_back(std::move(layer));
    }
    const auto is_there = [&](AttributeRole role) {
      return std::any_of(raw_.layers.begin(), raw_.layers.end(),
                         [&](const RawLayer& layer) { return layer.role == role; });
    };
    const bool has_normals = is_there(AttributeRole::Normal),
               has_colors = is_there(AttributeRole::Color);
    for (RawLayer& layer : faces_.layers) {
      scale_float_colors(layer, raw_.report.notes);
      layer.values.resize(std::size_t(layer.dimension) * sink_.face_count(), 0.0f);
      if ((layer.role == AttributeRole::Normal && has_normals) ||
          (layer.role == AttributeRole::Color && has_colors)) {
        layer.name = "face_" + layer.name;
        layer.role = AttributeRole::Other;
      }
      if (take_index(layer, header_.comments, raw_)) continue;
      raw_.layers.push_back(std::move(layer));
    }
    if (!texture_of_face_.empty()) {
      sink_.keep_faces();
      RawLayer texture{std::string(kTextureIndex),
                       AttributeRole::Other,
                       Interpolation::Categorical,
                       RawLayer::Per::Face,
                       1,
                       std::move(texture_of_face_),
                       {}};
      const bool is_one = std::ranges::count(texture.values, texture.values[0]) ==
                          static_cast<std::ptrdiff_t>(texture.values.size());
      const bool is_taken = take_index(texture, header_.comments, raw_);
      if (!is_taken && !is_one) raw_.layers.push_back(std::move(texture));
    }
    if (!uv_.empty() && uv_of_corner_.empty()) {
      raw_.report.notes.push_back("element 'multi_texture_vertex' ignored");
    } else if (!uv_.empty()) {
      uv_of_corner_.resize(3 * raw_.triangles.size(), kNone);
      RawLayer uv = texcoord_layer(is_there(AttributeRole::TexCoord) ? "corner_uv" : "uv",
                                   RawLayer::Per::Corner);
      uv.values = std::move(uv_);
      uv.of_corner = std::move(uv_of_corner_);
      raw_.layers.push_back(std::move(uv));
    }
    take_only_texture(header_.comments, raw_);
    sink_.report();
    if (short_faces_ > 0) {
      raw_.report.notes.push_back(std::to_string(short_faces_) +
                                  " faces with fewer than three corners ignored");
    }
  }

  const Source& source_;
  const PlyHeader& header_;
  PlyBody body_;
  RawMesh raw_;
  FaceSink sink_;
  std::optional<Failure> failure_;
  PlyLayers vertices_, faces_;
  std::size_t rows_with_more_ = 0, short_faces_ = 0;
  std::vector<double> list_, corner_uv_;
  std::vector<std::uint32_t> corners_;
  std::vector<float> uv_, texture_of_face_;
  std::vector<std::uint32_t> uv_of_corner_;
};

}  // namespace

Result<RawMesh> read_ply(const Source& source) {
  const Result<PlyHeader> header = read_ply_header(source);
  if (!header.ok()) return header.failure();
  return PlyReader(source, *header).read();
}

}  // namespace crease

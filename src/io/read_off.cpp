// OFF with its prefixes ST, C and N (in any case: any combination), polygons, comments, colours.
#include "io/face_sink.h"
#include "io/formats.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace crease {

namespace {

class OffReader {
 public:
  explicit OffReader(const Source& source) : source_(source), lines_(source.text()), sink_(raw_) {}

  Result<RawMesh> read() {
    raw_.report.format = "OFF";
    if (!read_header() || !read_vertices() || !read_faces()) return *failure_;
    add_vertex_layers();
    add_face_colors();
    sink_.report();
    if (short_faces_ > 0) {
      raw_.report.notes.push_back(std::to_string(short_faces_) +
                                  " faces with fewer than three corners ignored");
    }
    return std::move(raw_);
  }

 private:
  bool refuse(Error error, const std::string& reason) {
    failure_ = fail_at_line(error, source_, line_.line_number, reason);
    return false;
  }

  // The next line with something on it besides comments.
  bool next_line(const std::string& wanted) {
    while (lines_.next(line_)) {
      const char* comment = std::find(line_.at, line_.end, '#');
      line_.end = comment;
      if (!line_.done()) return true;
    }
    return refuse(Error::Truncated, "the file ends; " + wanted + " expected");
  }

  bool read_count(std::size_t& count, const char* what) {
    std::int64_t x = 0;
    if (line_.done() && !next_line(what)) return false;
    if (!line_.integer(x) || x < 0) {
      return refuse(Error::BadFormat,
                    std::string("number of ") + what + ": not a count: " + in_quotes(line_.word()));
    }
    count = static_cast<std::size_t>(x);
    return true;
  }

  bool read_header() {
    if (!next_line("OFF")) return false;
    Line probe = line_;
    std::string_view word = probe.word();
    if (word.ends_with("OFF")) {
      line_ = probe;
      word.remove_suffix(3);
      has_texcoords_ = word.starts_with("ST");
      if (has_texcoords_) word.remove_prefix(2);
      has_colors_ = word.starts_with("C");
      if (has_colors_) word.remove_prefix(1);
      has_normals_ = word.starts_with("N");
      if (has_normals_) word.remove_prefix(1);
      if (!word.empty()) {
        return refuse(Error::NotSupported, "OFF of more than three dimensions: " + in_quotes(word));
      }
      if (Line rest = line_; rest.word() == "BINARY") {
        return refuse(Error::NotSupported, "binary OFF; convert it to text");
      }
    }  // else: no keyword, the counts come first
    std::size_t unused_edges = 0;
    if (!read_count(vertex_count_, "vertices") || !read_count(face_count_, "faces")) return false;
    if (!line_.done()) read_count(unused_edges, "edges");
    if (failure_) return false;
    // A vertex takes at least the six characters "0 0 0\n", a face "3 0 0 0\n" or "0\n".
    const std::size_t left =
        source_.text().size() - static_cast<std::size_t>(lines_.position() - source_.text().data());
    if (left == 0 && !line_.done()) {
      return refuse(Error::NotSupported, "vertices and faces have no lines of their own");
    }
    if (vertex_count_ > left / 5 || face_count_ > left / 2 + 1) {
      return refuse(Error::Truncated, "the header promises " + std::to_string(vertex_count_) +
                                          " vertices and " + std::to_string(face_count_) +
                                          " faces, more than the " + std::to_string(left) +
                                          " bytes after it can hold");
    }
    return true;
  }

  bool read_numbers(std::size_t count, double* out, const char* what) {
    for (std::size_t i = 0; i < count; ++i) {
      if (line_.number(out[i])) continue;
      if (line_.done()) return refuse(Error::BadFormat, std::string(what) + " has too few numbers");
      return refuse(Error::BadFormat,
                    std::string(what) + ": not a number: " + in_quotes(line_.word()));
    }
    return true;
  }

  bool read_vertices() {
    raw_.positions.reserve(vertex_count_);
    for (std::size_t v = 0; v < vertex_count_; ++v) {
      const auto what = [&] {
        return "vertex " + std::to_string(v) + " of " + std::to_string(vertex_count_);
      };
      if (!next_line("a vertex")) return false;
      std::array<double, 3> x;
      if (!read_numbers(3, x.data(), "vertex")) return false;
      const Vec3d p{x[0], x[1], x[2]};
      if (!is_position(p)) return refuse(Error::BadValue, what() + " is " + fault_of(p));
      raw_.positions.push_back(p);
      if (has_normals_) {
        if (!read_numbers(3, x.data(), "vertex normal")) return false;
        for (double n : x) normals_.push_back(static_cast<float>(n));
      }
      // Colours are three or four numbers; texture coordinates, if any, are the last two.
      rest_.clear();
      for (double c; line_.number(c);) rest_.push_back(c);
      if (!line_.done()) {
        return refuse(Error::BadFormat, what() + ": not a number: " + in_quotes(line_.word()));
      }
      if (has_texcoords_) {
        if (rest_.size() < 2)
          return refuse(Error::BadFormat, what() + " lacks texture coordinates");
        for (std::size_t i = rest_.size() - 2; i < rest_.size(); ++i) {
          texcoords_.push_back(static_cast<float>(rest_[i]));
        }
        rest_.resize(rest_.size() - 2);
      }
      if (has_colors_) {
        if (rest_.size() < 3) return refuse(Error::BadFormat, what() + " lacks a colour");
        for (std::size_t i = 0; i < 4; ++i) {
          colors_.push_back(static_cast<float>(i < rest_.size() ? rest_[i] : kOpaque));
        }
      }
    }
    return true;
  }

  static std::string corner_of_face(std::int64_t corner, std::int64_t count) {
    return "corner " + std::to_string(corner) + " of " + std::to_string(count) + " of a face";
  }

  bool read_faces() {
    raw_.triangles.reserve(face_count_);
    for (std::size_t f = 0; f < face_count_; ++f) {
      if (!next_line("face " + std::to_string(f) + " of " + std::to_string(face_count_))) {
        return false;
      }
      std::int64_t count = 0;
      if (!line_.integer(count) || count < 0) {
        return refuse(Error::BadFormat,
                      "face: not a number of corners: " + in_quotes(line_.word()));
      }
      corners_.clear();
      for (std::int64_t c = 0; c < count; ++c) {
        std::int64_t v = 0;
        // A face may go on in the next line.
        if (line_.done() && !next_line(corner_of_face(c, count))) return false;
        if (!line_.integer(v)) {
          return refuse(Error::BadFormat,
                        corner_of_face(c, count) + ": not an index: " + in_quotes(line_.word()));
        }
        if (v < 0 || static_cast<std::size_t>(v) >= vertex_count_) {
          return refuse(Error::BadValue, "face index " + std::to_string(v) + " of " +
                                             std::to_string(vertex_count_) + " vertices");
        }
        corners_.push_back(static_cast<std::uint32_t>(v));
      }
      if (corners_.size() < 3) {
        ++short_faces_;
        continue;
      }
      sink_.add_face(corners_);
      keep_face_color();
    }
    return true;
  }

  // What follows the corners: nothing, an index into a colour table, or three or four components.
  void keep_face_color() {
    rest_.clear();
    for (double c; line_.number(c) && rest_.size() < 4;) rest_.push_back(c);
    if (rest_.empty() && face_colors_.empty() && face_categories_.empty()) return;
    const std::size_t before = sink_.face_count() - 1;
    if (rest_.size() == 1 || rest_.size() == 2) {
      face_categories_.resize(before, 0.0f);
      face_categories_.push_back(static_cast<float>(rest_[0]));
    } else if (rest_.size() >= 3) {
      face_colors_.resize(4 * before, kNoColor);
      for (std::size_t i = 0; i < 4; ++i) {
        face_colors_.push_back(static_cast<float>(i < rest_.size() ? rest_[i] : kOpaque));
      }
    }
  }

  // 0..255 if any component but a missing alpha is beyond 1, else 0..1.
  void scale_colors(std::vector<float>& colors) const {
    bool bytes = false;
    for (float c : colors) bytes = bytes || c > 1;
    for (float& c : colors) {
      c = c == static_cast<float>(kOpaque) || c == kNoColor ? 1.0f : bytes ? c / 255.0f : c;
    }
  }

  void add_vertex_layers() {
    const auto add = [&](RawLayer layer, std::vector<float>& values) {
      layer.values = std::move(values);
      raw_.layers.push_back(std::move(layer));
    };
    if (has_normals_) add(normal_layer(RawLayer::Per::Vertex), normals_);
    if (has_texcoords_) add(texcoord_layer("uv", RawLayer::Per::Vertex), texcoords_);
    if (has_colors_) {
      scale_colors(colors_);
      add(color_layer(RawLayer::Per::Vertex, 4), colors_);
    }
  }

  void add_face_colors() {
    if (!face_colors_.empty()) {
      sink_.keep_faces();
      face_colors_.resize(std::size_t(4) * sink_.face_count(), kNoColor);
      scale_colors(face_colors_);
      RawLayer layer = color_layer(RawLayer::Per::Face, 4);
      layer.values = std::move(face_colors_);
      if (has_colors_) {
        layer.name = "face_color";
        layer.role = AttributeRole::Other;
      }
      raw_.layers.push_back(std::move(layer));
    }
    if (!face_categories_.empty()) {
      sink_.keep_faces();
      face_categories_.resize(sink_.face_count(), 0.0f);
      raw_.layers.push_back({"color_index",
                             AttributeRole::Other,
                             Interpolation::Categorical,
                             RawLayer::Per::Face,
                             1,
                             std::move(face_categories_),
                             {}});
    }
  }

  // Marks that no file's value has.
  static constexpr double kOpaque = -1;
  static constexpr float kNoColor = -2;

  const Source& source_;
  LineReader lines_;
  Line line_;
  RawMesh raw_;
  FaceSink sink_;
  std::optional<Failure> failure_;
  bool has_texcoords_ = false, has_colors_ = false, has_normals_ = false;
  std::size_t vertex_count_ = 0, face_count_ = 0, short_faces_ = 0;
  std::vector<float> normals_, texcoords_, colors_, face_colors_, face_categories_;
  std::vector<double> rest_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<RawMesh> read_off(const Source& source) {
  return OffReader(source).read();
}

}  // namespace crease

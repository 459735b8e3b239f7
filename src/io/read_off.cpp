// OFF with its prefixes ST, C and N (any combination, in this order), polygons, comments, colours,
// as text and binary.
#include "io/binary_off.h"
#include "io/face_sink.h"
#include "io/formats.h"
#include "io/off_colors.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

namespace {

class OffReader {
 public:
  explicit OffReader(const Source& source) : source_(source), lines_(source.text()), sink_(raw_) {}

  Result<RawMesh> read() {
    raw_.report.format = "OFF";
    if (!next_line("OFF") || !read_keyword()) return *failure_;
    const bool is_read =
        is_binary_ ? read_binary() : read_counts() && read_vertices() && read_faces() && read_end();
    if (!is_read) return *failure_;
    add_vertex_layers();
    add_face_colors();
    sink_.report();
    note_ignored();
    return std::move(raw_);
  }

 private:
  bool refuse(Error error, const std::string& reason) {
    failure_ = fail_at_line(error, source_, line_.line_number, reason);
    return false;
  }

  // Up to a comment.
  static void cut_comment(Line& line) { line.end = std::find(line.at, line.end, '#'); }

  // To the next line with something on it; false at the end.
  bool find_line() {
    while (lines_.next(line_)) {
      cut_comment(line_);
      if (!line_.done()) return true;
    }
    return false;
  }

  bool next_line(const std::string& wanted) {
    return find_line() || refuse(Error::Truncated, "the file ends; " + wanted + " expected");
  }

  // After the one in hand, with something on them.
  bool has_lines(std::size_t count) const {
    LineReader lines = lines_;
    for (Line line; count > 0 && lines.next(line);) {
      cut_comment(line);
      if (!line.done()) --count;
    }
    return count == 0;
  }

  // On the next line with something on it. No count: there is more than numbers, or no line.
  struct Numbers {
    double first = 0;
    std::size_t count = 0;
  };
  Numbers next_numbers() const {
    LineReader lines = lines_;
    for (Line line; lines.next(line);) {
      cut_comment(line);
      if (line.done()) continue;
      Numbers numbers;
      for (double x; line.number(x); ++numbers.count) {
        if (numbers.count == 0) numbers.first = x;
      }
      return line.done() ? numbers : Numbers{};
    }
    return {};
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

  // "OFF" with what stands before it, and nothing behind it but a count ("OFF8 6 12"). A file
  // without begins with the counts.
  bool read_keyword() {
    Line probe = line_;
    const std::string_view word = probe.word();
    const std::size_t off = word.find("OFF");
    if (off == word.npos) return true;
    const std::string_view behind = word.substr(off + 3);
    if (!behind.empty() && (behind[0] < '0' || behind[0] > '9')) return true;
    line_.at = behind.data();
    keyword_ = word.substr(0, off + 3);
    std::string_view prefix = word.substr(0, off);
    has_texcoords_ = prefix.starts_with("ST");
    if (has_texcoords_) prefix.remove_prefix(2);
    has_colors_ = prefix.starts_with("C");
    if (has_colors_) prefix.remove_prefix(1);
    has_normals_ = prefix.starts_with("N");
    if (has_normals_) prefix.remove_prefix(1);
    if (!prefix.empty()) {
      return refuse(Error::NotSupported, "OFF of more than three dimensions: " + in_quotes(prefix));
    }
    Line rest = line_;
    is_binary_ = rest.word() == "BINARY";
    return true;
  }

  bool read_binary() {
    const auto begin = static_cast<std::size_t>(lines_.position() - source_.text().data());
    const std::size_t normal_end = has_normals_ ? 6 : 3;
    const std::size_t color_end = normal_end + (has_colors_ ? 4 : 0);
    std::vector<float> row(color_end + (has_texcoords_ ? 2 : 0));
    BinaryOff rows(source_.bytes.subspan(begin), row.size());
    const auto refuse_at = [&](std::size_t offset, Error error, const std::string& reason) {
      failure_ = fail_at_byte(error, source_, begin + offset, reason);
      return false;
    };
    if (!rows.open()) {
      return refuse_at(0, Error::Truncated,
                       "vertices and faces of a binary OFF do not fit into the " +
                           std::to_string(source_.bytes.size() - begin) + " bytes that are left");
    }
    vertex_count_ = rows.vertex_count();
    face_count_ = rows.face_count();
    raw_.positions.reserve(vertex_count_);
    for (std::size_t v = 0; v < vertex_count_; ++v) {
      const std::size_t offset = rows.offset();
      rows.take_vertex(row);
      const Vec3d p{row[0], row[1], row[2]};
      if (!is_position(p)) {
        return refuse_at(offset, Error::BadValue,
                         "vertex " + std::to_string(v) + " is " + fault_of(p));
      }
      raw_.positions.push_back(p);
      normals_.insert(normals_.end(), row.begin() + 3, row.begin() + std::ptrdiff_t(normal_end));
      row_.assign(row.begin() + std::ptrdiff_t(normal_end),
                  row.begin() + std::ptrdiff_t(color_end));
      if (has_colors_) colors_.add(row_, false);
      texcoords_.insert(texcoords_.end(), row.begin() + std::ptrdiff_t(color_end), row.end());
    }
    raw_.triangles.reserve(face_count_);
    for (std::size_t f = 0; f < face_count_; ++f) {
      const std::size_t offset = rows.offset();
      rows.take_face(corners_, row_);
      for (std::uint32_t v : corners_) {
        if (v < vertex_count_) continue;
        return refuse_at(offset, Error::BadValue, index_of_many(v));
      }
      add_face([&] { keep_face_color(false); });
    }
    if (!rows.at_end()) raw_.report.notes.push_back("bytes after the last face ignored");
    return true;
  }

  std::string index_of_many(std::int64_t v) const {
    return "face index " + std::to_string(v) + " of " + std::to_string(vertex_count_) + " vertices";
  }

  bool read_counts() {
    std::size_t unused_edges = 0;
    if (!read_count(vertex_count_, "vertices") || !read_count(face_count_, "faces")) return false;
    if (!line_.done() && !read_count(unused_edges, "edges")) return false;
    // A vertex takes at least the six characters "0 0 0\n", a face "3 0 0 0\n" or "0\n".
    const std::string_view text = source_.text();
    const auto left = static_cast<std::size_t>(text.data() + text.size() - line_.at);
    if (vertex_count_ > left / 5 || face_count_ > left / 2 + 1) {
      return refuse(Error::Truncated, "the header promises " + std::to_string(vertex_count_) +
                                          " vertices and " + std::to_string(face_count_) +
                                          " faces, more than the " + std::to_string(left) +
                                          " bytes after it can hold");
    }
    return true;
  }

  // Adds the next number of the line in hand to the row.
  bool take_number() {
    Line probe = line_;
    std::int64_t unused = 0;
    const bool is_whole = probe.integer(unused);
    double x = 0;
    if (!line_.number(x)) return false;
    row_.push_back(x);
    row_is_whole_.push_back(is_whole);
    return true;
  }
  void clear_row() {
    row_.clear();
    row_is_whole_.clear();
  }
  void add_color(OffColors& to, std::size_t begin, std::size_t end) const {
    const bool is_whole = std::all_of(row_is_whole_.begin() + static_cast<std::ptrdiff_t>(begin),
                                      row_is_whole_.begin() + static_cast<std::ptrdiff_t>(end),
                                      [](bool whole) { return whole; });
    to.add(std::span(row_).subspan(begin, end - begin), is_whole);
  }

  // A vertex with a line of its own has all numbers of it, and goes on in the next one if these are
  // too few; else it has as many as the keyword says. Colours are three or four.
  template <typename What>
  bool read_vertex_row(std::size_t least, std::size_t most, What what) {
    clear_row();
    if ((rows_are_lines_ || line_.done()) && !next_line("a vertex")) return false;
    const std::size_t first_line = line_.line_number;
    const std::size_t wanted = rows_are_lines_ ? least : most;
    while (row_.size() < wanted || (rows_are_lines_ && !line_.done())) {
      if (line_.done() && !next_line("more of " + what())) return false;
      if (!take_number()) {
        return refuse(Error::BadFormat, what() + ": not a number: " + in_quotes(line_.word()));
      }
    }
    if (row_.size() <= most) return true;
    if (line_.line_number != first_line) {  // the next line is another vertex
      line_.line_number = first_line;
      return refuse(Error::BadFormat, what() + " has too few numbers");
    }
    ++long_vertices_;
    return true;
  }

  bool read_vertices() {
    const std::size_t texcoord_numbers = has_texcoords_ ? 2 : 0;
    const std::size_t color_begin = has_normals_ ? 6 : 3;
    const std::size_t least = color_begin + (has_colors_ ? 3 : 0) + texcoord_numbers;
    const std::size_t most = least + (has_colors_ ? 1 : 0);
    const std::size_t on_line = line_.done() ? next_numbers().count : 0;
    rows_are_lines_ =
        has_lines(vertex_count_ + face_count_) || (on_line >= least && on_line <= most);
    if (rows_are_lines_ && !line_.rest().empty()) {
      raw_.report.notes.push_back("what follows the counts ignored");
    }
    raw_.positions.reserve(vertex_count_);
    for (std::size_t v = 0; v < vertex_count_; ++v) {
      const auto what = [&] {
        return "vertex " + std::to_string(v) + " of " + std::to_string(vertex_count_);
      };
      if (!read_vertex_row(least, most, what)) return false;
      const Vec3d p{row_[0], row_[1], row_[2]};
      if (!is_position(p)) return refuse(Error::BadValue, what() + " is " + fault_of(p));
      raw_.positions.push_back(p);
      for (std::size_t i = 3; i < color_begin; ++i) {
        normals_.push_back(static_cast<float>(row_[i]));
      }
      const std::size_t color_end = row_.size() - texcoord_numbers;
      if (has_colors_) add_color(colors_, color_begin, std::min(color_end, color_begin + 4));
      for (std::size_t i = color_end; i < row_.size(); ++i) {
        if (has_texcoords_) texcoords_.push_back(static_cast<float>(row_[i]));
      }
    }
    return true;
  }

  static std::string corner_of_face(std::int64_t corner, std::int64_t count) {
    return "corner " + std::to_string(corner) + " of " + std::to_string(count) + " of a face";
  }

  // With a colour or without.
  bool has_face_line() const {
    const Numbers numbers = next_numbers();
    const auto behind = static_cast<double>(numbers.count) - 1 - numbers.first;
    return numbers.count > 0 && behind >= 0 && behind <= 4;
  }

  bool read_faces() {
    runs_on_ = !rows_are_lines_;
    rows_are_lines_ = line_.done() && (has_lines(face_count_) || has_face_line());
    runs_on_ = runs_on_ || !rows_are_lines_;
    raw_.triangles.reserve(face_count_);
    for (std::size_t f = 0; f < face_count_; ++f) {
      if ((rows_are_lines_ || line_.done()) &&
          !next_line("face " + std::to_string(f) + " of " + std::to_string(face_count_))) {
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
          return refuse(Error::BadValue, index_of_many(v));
        }
        corners_.push_back(static_cast<std::uint32_t>(v));
      }
      add_face([&] {
        if (rows_are_lines_) read_face_color();
      });
    }
    return true;
  }

  // `keep_color` is called if it is one.
  template <typename KeepColor>
  void add_face(KeepColor keep_color) {
    if (corners_.size() < 3) {
      ++short_faces_;
      return;
    }
    sink_.add_face(corners_);
    keep_color();
  }

  // What follows the corners in their line.
  void read_face_color() {
    clear_row();
    while (row_.size() < 4 && take_number()) {
    }
    if (!line_.done() || row_.size() == 2) ++long_faces_;
    keep_face_color(std::ranges::find(row_is_whole_, false) == row_is_whole_.end());
  }

  // The row in hand: nothing, an index into a colour table, or three or four components.
  void keep_face_color(bool is_whole) {
    const std::size_t before = sink_.face_count() - 1;
    if (row_.size() == 1 || row_.size() == 2) {
      face_categories_.resize(before, 0.0f);
      face_categories_.push_back(static_cast<float>(row_[0]));
    } else if (row_.size() >= 3) {
      face_colors_.fill(before);
      face_colors_.add(row_, is_whole);
    }
  }

  // Where rows have no lines of their own, numbers that are left tell that they were taken for
  // something else.
  bool read_end() {
    if (runs_on_ && (!line_.done() || find_line())) {
      return refuse(Error::BadFormat,
                    "vertices and faces have no lines of their own, and more numbers than the "
                    "header says: " +
                        in_quotes(line_.word()));
    }
    if (!runs_on_ && find_line()) raw_.report.notes.push_back("lines after the last face ignored");
    return true;
  }

  void add_vertex_layers() {
    const auto add = [&](RawLayer layer, std::vector<float> values) {
      layer.values = std::move(values);
      raw_.layers.push_back(std::move(layer));
    };
    if (has_normals_) add(normal_layer(RawLayer::Per::Vertex), std::move(normals_));
    if (has_texcoords_) add(texcoord_layer("uv", RawLayer::Per::Vertex), std::move(texcoords_));
    if (has_colors_) add(color_layer(RawLayer::Per::Vertex, 4), colors_.take());
  }

  void add_face_colors() {
    if (!face_colors_.empty()) {
      sink_.keep_faces();
      face_colors_.fill(sink_.face_count());
      RawLayer layer = color_layer(RawLayer::Per::Face, 4);
      layer.values = face_colors_.take();
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

  void note_ignored() {
    const auto note = [&](std::size_t count, const std::string& what) {
      if (count > 0) raw_.report.notes.push_back(std::to_string(count) + what + " ignored");
    };
    note(long_vertices_, " vertices hold more numbers than " + in_quotes(keyword_) + " says:");
    note(long_faces_, " faces have more behind them than a colour:");
    note(short_faces_, " faces with fewer than three corners");
  }

  const Source& source_;
  LineReader lines_;
  Line line_;
  RawMesh raw_;
  FaceSink sink_;
  std::optional<Failure> failure_;
  std::string keyword_ = "OFF";
  bool has_texcoords_ = false, has_colors_ = false, has_normals_ = false, is_binary_ = false;
  // OFF is free of lines but behind a face, where they end a colour. Rows have lines of their own
  // where there are enough for all, or, since a file may be cut, where the first is such a line.
  bool rows_are_lines_ = true;
  bool runs_on_ = false;  // some rows have not
  std::size_t vertex_count_ = 0, face_count_ = 0;
  std::size_t long_vertices_ = 0, long_faces_ = 0, short_faces_ = 0;
  std::vector<double> row_;
  std::vector<bool> row_is_whole_;  // of its numbers: no point, no exponent
  std::vector<float> normals_, texcoords_, face_categories_;
  OffColors colors_, face_colors_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<RawMesh> read_off(const Source& source) {
  return OffReader(source).read();
}

}  // namespace crease

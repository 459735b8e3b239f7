// OBJ in two passes over the text: first all v, vt and vn, so that counts are known and faces may
// come before their vertices; then faces with the state that s, g, o and usemtl set.
#include "io/face_sink.h"
#include "io/formats.h"
#include "io/material_libraries.h"
#include "io/text.h"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

namespace crease {

namespace {

enum ValueKind { kPosition, kTexCoord, kNormal };
constexpr std::array<const char*, 3> kValueNames{"vertices", "texture coordinates", "normals"};

constexpr std::string_view kPaint = "#MRGB";

class ObjReader {
 public:
  explicit ObjReader(const Source& source) : source_(source), sink_(raw_) {}

  Result<RawMesh> read() {
    raw_.report.format = "OBJ";
    const std::string_view text = source_.text();
    if (text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe")) {
      return fail_at_byte(Error::BadFormat, source_, 0, "UTF-16 text; save it as UTF-8");
    }
    if (!each_line([&](std::string_view word, Line& line) { return read_value(word, line); })) {
      return *failure_;
    }
    if (known_lines_ == 0) {
      return fail_at_line(Error::BadFormat, source_, 1,
                          "not an OBJ file: no v and no f line anywhere");
    }
    if (raw_.positions.size() >= kNone) {
      return fail(Error::OverLimit, source_.name + ": more than 4 294 967 294 vertices");
    }
    take_paint();
    scale_colors();
    raw_.triangles.reserve(face_lines_);
    count_ = {};
    if (!each_line([&](std::string_view word, Line& line) { return read_structure(word, line); })) {
      return *failure_;
    }
    finish();
    return std::move(raw_);
  }

 private:
  // A backslash at a line's end continues it. False: failure_ is set.
  template <typename Visit>
  bool each_line(Visit visit) {
    std::string_view text = source_.text();
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // UTF-8 mark
    LineReader lines(text, true);
    for (Line line; lines.next(line);) {
      line_number_ = line.line_number;
      if ((line_number_ & 0xffff) == 0 && !goes_on()) return false;
      const std::string_view word = line.word();
      if (word == "#") read_comment(line.rest());
      if (word.empty() || (word[0] == '#' && word != kPaint)) continue;
      if (!visit(word, line)) return false;
    }
    return true;
  }

  // As write_obj() writes it.
  void read_comment(std::string_view text) {
    if (text == "up y" || text == "up z") raw_.up = text == "up y" ? UpAxis::Y : UpAxis::Z;
  }

  bool goes_on() {
    if (!source_.progress || !*source_.progress || (*source_.progress)("read", 0.5)) return true;
    return refuse(Error::Interrupted, "interrupted");
  }

  bool refuse(Error error, const std::string& reason) {
    failure_ = fail_at_line(error, source_, line_number_, reason);
    return false;
  }

  bool not_a_number(Line& line, const char* what) {
    if (line.done()) return refuse(Error::BadFormat, std::string(what) + " has too few numbers");
    return refuse(Error::BadFormat,
                  std::string(what) + ": not a number: " + in_quotes(line.word()));
  }

  // First pass.
  bool read_value(std::string_view word, Line& line) {
    if (word == "v") return read_position(line);
    if (word == "vn") return read_normal(line);
    if (word == "vt") return read_texcoord(line);
    if (word == kPaint) read_paint(line.rest());
    if (word == "f" || word == "fo") {
      ++known_lines_;
      ++face_lines_;
    }
    if (word == "s") has_smoothing_groups_ = true;
    return true;
  }

  bool read_position(Line& line) {
    ++known_lines_;
    std::array<double, 8> x;
    std::size_t count = 0;
    while (count < x.size() && line.number(x[count])) ++count;
    if (!line.done() && line.at[0] != '#') return not_a_number(line, "vertex");
    if (count < 3) return not_a_number(line, "vertex");
    const Vec3d p{x[0], x[1], x[2]};
    if (!is_position(p)) {
      return refuse(Error::BadValue, std::string("vertex is ") + fault_of(p));
    }
    raw_.positions.push_back(p);
    if (count == 6 || count == 7) {
      colors_.resize(3 * (raw_.positions.size() - 1), 1.0f);  // white where there was none
      for (std::size_t i = count - 3; i < count; ++i) colors_.push_back(static_cast<float>(x[i]));
    }
    return true;
  }

  bool read_normal(Line& line) {
    Vec3d n;
    if (!line.number(n.x) || !line.number(n.y) || !line.number(n.z)) {
      return not_a_number(line, "normal");
    }
    for (int i = 0; i < 3; ++i) normals_.push_back(static_cast<float>(n[i]));
    return true;
  }

  bool read_texcoord(Line& line) {
    double u = 0, v = 0;
    if (!line.number(u)) return not_a_number(line, "texture coordinate");
    if (!line.done() && !line.number(v)) return not_a_number(line, "texture coordinate");
    texcoords_.push_back(static_cast<float>(u));
    texcoords_.push_back(static_cast<float>(v));
    if (double w; line.number(w) && w != 0) ++texcoords_with_depth_;
    return true;
  }

  // ZBrush writes colours of vertices as a comment: eight digits each, a mask, red, green and blue.
  void read_paint(std::string_view digits) {
    for (; digits.size() >= 8; digits.remove_prefix(8)) {
      std::uint32_t color = 0;
      const auto got = std::from_chars(digits.data(), digits.data() + 8, color, 16);
      if (got.ptr != digits.data() + 8) return;
      for (int shift : {16, 8, 0}) {
        paint_.push_back(static_cast<float>(color >> shift & 0xff) / 255.0f);
      }
    }
  }

  void take_paint() {
    if (paint_.empty()) return;
    if (colors_.empty() && paint_.size() == 3 * raw_.positions.size()) {
      colors_ = std::move(paint_);
    } else {
      raw_.report.notes.push_back(std::to_string(paint_.size() / 3) +
                                  " colours in comments ignored, as they are not those of the " +
                                  std::to_string(raw_.positions.size()) + " vertices");
    }
  }

  // Colours after coordinates are 0..1 mostly; some programs write 0..255.
  void scale_colors() {
    if (colors_.empty()) return;
    colors_.resize(3 * raw_.positions.size(), 1.0f);
    bool bytes = false;
    for (float c : colors_) bytes = bytes || (c > 1.5f && c <= 255.0f);
    if (bytes) {
      for (float& c : colors_) c /= 255.0f;
      raw_.report.notes.push_back("vertex colours divided by 255");
    }
    RawLayer layer = color_layer(RawLayer::Per::Vertex, 3);
    layer.values = std::move(colors_);
    raw_.layers.push_back(std::move(layer));
  }

  // Second pass.
  bool read_structure(std::string_view word, Line& line) {
    if (word == "v") {
      ++count_[kPosition];
    } else if (word == "vt") {
      ++count_[kTexCoord];
    } else if (word == "vn") {
      ++count_[kNormal];
    } else if (word == "f" || word == "fo") {
      return read_face(line);
    } else if (word == "s") {
      return read_smoothing_group(line);
    } else if (word == "g") {
      group_ = line.rest();
      part_is_known_ = false;
      names_parts_ = true;
    } else if (word == "o") {
      object_ = line.rest();
      group_.clear();
      part_is_known_ = false;
      names_parts_ = true;
    } else if (word == "usemtl") {
      material_ = material_named(std::string(line.rest()));
    } else if (word == "mtllib") {
      libraries_.emplace_back(line.rest());
    } else if (word != kPaint) {
      ++(ignored_.size() < kMaxIgnoredWords || ignored_.contains(word) ? ignored_[std::string(word)]
                                                                       : ignored_["other words"]);
    }
    return true;
  }

  bool read_smoothing_group(Line& line) {
    const std::string_view word = line.word();
    if (word == "off" || word.empty()) {
      smoothing_group_ = 0;
      return true;
    }
    const auto got = std::from_chars(word.data(), word.data() + word.size(), smoothing_group_);
    if (word == "on") {
      smoothing_group_ = 1;
    } else if (got.ec != std::errc() || got.ptr != word.data() + word.size()) {
      return refuse(Error::BadFormat, "smoothing group: not a number or off: " + in_quotes(word));
    }
    return true;
  }

  MaterialId material_named(std::string name) {
    const auto [found, is_new] =
        material_of_name_.emplace(name, static_cast<std::uint32_t>(raw_.materials.size()));
    if (is_new) raw_.materials.push_back({std::move(name), {1, 1, 1, 1}, {}});
    return MaterialId{found->second};
  }

  PartId current_part() {
    if (part_is_known_) return part_;
    std::string name = object_;
    if (!group_.empty()) {
      if (!name.empty()) name += '/';
      name += group_;
    }
    const auto [found, is_new] =
        part_of_name_.emplace(name, static_cast<std::uint32_t>(raw_.parts.size()));
    if (is_new) raw_.parts.push_back(std::move(name));
    part_is_known_ = true;
    return part_ = PartId{found->second};
  }

  // One index of a face corner, from 0. Empty ("1//2", "1/") is none.
  bool read_index(const char*& at, const char* end, ValueKind kind, std::uint32_t& index) {
    index = kNone;
    if (at == end || *at == '/') return true;
    std::int64_t i = 0;
    const auto got = std::from_chars(at, end, i);
    if (got.ec != std::errc() || (got.ptr != end && *got.ptr != '/')) {
      return refuse(Error::BadFormat, "face corner " +
                                          in_quotes({at, static_cast<std::size_t>(end - at)}) +
                                          " is not v, v/vt, v//vn or v/vt/vn");
    }
    at = got.ptr;
    const std::int64_t total = static_cast<std::int64_t>(total_of(kind));
    const std::int64_t from_zero = i > 0 ? i - 1 : static_cast<std::int64_t>(count_[kind]) + i;
    if (i == 0) return refuse(Error::BadValue, "face index 0: OBJ counts from 1");
    // Normals or texture coordinates stripped from the file, their indices left behind.
    if (total == 0 && kind != kPosition) {
      has_orphans_[kind] = true;
      return true;
    }
    if (from_zero < 0 || from_zero >= total) {
      return refuse(Error::BadValue, "face index " + std::to_string(i) + " of " +
                                         std::to_string(i > 0 ? total_of(kind) : count_[kind]) +
                                         " " + kValueNames[kind]);
    }
    index = static_cast<std::uint32_t>(from_zero);
    return true;
  }

  std::size_t total_of(ValueKind kind) const {
    return kind == kPosition   ? raw_.positions.size()
           : kind == kTexCoord ? texcoords_.size() / 2
                               : normals_.size() / 3;
  }

  bool read_face(Line& line) {
    for (auto& indices : corner_) indices.clear();
    while (!line.done() && line.at[0] != '#') {
      const std::string_view word = line.word();
      const char* at = word.data();
      const char* end = at + word.size();
      for (ValueKind kind : {kPosition, kTexCoord, kNormal}) {
        std::uint32_t index = kNone;
        if (kind != kPosition && at != end) ++at;  // the slash
        if (!read_index(at, end, kind, index)) return false;
        corner_[kind].push_back(index);
      }
      if (at != end || corner_[kPosition].back() == kNone) {
        return refuse(Error::BadFormat,
                      "face corner " + in_quotes(word) + " is not v, v/vt, v//vn or v/vt/vn");
      }
    }
    if (corner_[kPosition].size() < 3) {
      ++short_faces_;
      return true;
    }
    sink_.add_face(corner_[kPosition]);
    add_triangles();
    return true;
  }

  void add_triangles() {
    const std::size_t before = raw_.triangles.size() - sink_.cut().size();
    add_corners(kTexCoord, before, texcoord_of_corner_);
    add_corners(kNormal, before, normal_of_corner_);
    const std::size_t after = raw_.triangles.size();
    if (has_smoothing_groups_) raw_.smoothing_group.resize(after, smoothing_group_);
    if (material_ || !raw_.material_of_triangle.empty()) {
      if (raw_.material_of_triangle.empty() && before > 0) {
        raw_.material_of_triangle.resize(before, material_named(""));
      }
      raw_.material_of_triangle.resize(after, *material_);
    }
    if (names_parts_) {
      if (raw_.part_of_triangle.empty() && before > 0) {
        const PartId part = current_part();
        const auto [found, is_new] =
            part_of_name_.emplace("", static_cast<std::uint32_t>(raw_.parts.size()));
        if (is_new) raw_.parts.emplace_back();
        raw_.part_of_triangle.resize(before, PartId{found->second});
        part_ = part;
      }
      raw_.part_of_triangle.resize(after, current_part());
    }
  }

  void add_corners(ValueKind kind, std::size_t before, std::vector<std::uint32_t>& of_corner) {
    const std::vector<std::uint32_t>& corners = corner_[kind];
    if (of_corner.empty()) {
      bool any = false;
      for (std::uint32_t i : corners) any = any || i != kNone;
      if (!any) return;
      of_corner.resize(3 * before, kNone);
    }
    for (const auto& triangle : sink_.cut()) {
      for (std::uint32_t rank : triangle) of_corner.push_back(corners[rank]);
    }
  }

  void add_layer(RawLayer layer, std::vector<float> values, std::vector<std::uint32_t> of_corner) {
    if (of_corner.empty()) return;
    layer.values = std::move(values);
    layer.of_corner = std::move(of_corner);
    raw_.layers.push_back(std::move(layer));
  }

  void finish() {
    add_layer(normal_layer(RawLayer::Per::Corner), std::move(normals_),
              std::move(normal_of_corner_));
    add_layer(texcoord_layer("uv", RawLayer::Per::Corner), std::move(texcoords_),
              std::move(texcoord_of_corner_));
    // Before the first `o` or `usemtl` there were no faces, or they were given the name "".
    if (raw_.material_of_triangle.empty()) raw_.materials.clear();
    read_libraries();
    sink_.report();
    std::vector<std::string>& notes = raw_.report.notes;
    if (short_faces_ > 0) {
      notes.push_back(std::to_string(short_faces_) +
                      " faces with fewer than three corners ignored");
    }
    for (ValueKind kind : {kTexCoord, kNormal}) {
      if (!has_orphans_[kind]) continue;
      notes.push_back(std::string("faces name ") + kValueNames[kind] +
                      " that the file does not have");
    }
    if (texcoords_with_depth_ > 0) {
      notes.push_back("third texture coordinate ignored");
    }
    for (const auto& [word, count] : ignored_) {
      const std::string what = word == "p"   ? "points"
                               : word == "l" ? "lines"
                                             : in_quotes(word) + " lines";
      notes.push_back(std::to_string(count) + " " + what + " ignored");
    }
  }

  void read_libraries() {
    if (raw_.materials.empty()) return;
    if (source_.folder == nullptr) {
      if (libraries_.empty()) return;
      raw_.report.notes.push_back("material libraries left out: there is no folder to look in");
      return;
    }
    MaterialLibraries libraries =
        read_material_libraries(*source_.folder, libraries_, raw_.materials);
    for (std::string& note : libraries.notes) raw_.report.notes.push_back(std::move(note));
    raw_.report.libraries = std::move(libraries.files);
    place_textures(libraries.placement_of_material);
  }

  // Texture coordinates as the texture of their material lies on them, so that it needs no more.
  void place_textures(std::span<const TexturePlacement> placement_of_material) {
    const auto uv = std::ranges::find(raw_.layers, AttributeRole::TexCoord, &RawLayer::role);
    if (uv == raw_.layers.end()) return;
    std::map<std::pair<MaterialId, std::uint32_t>, std::uint32_t> placed;
    for (std::size_t corner = 0; corner < uv->of_corner.size(); ++corner) {
      const MaterialId material = raw_.material_of_triangle[corner / 3];
      const TexturePlacement& placement = placement_of_material[index_of(material)];
      std::uint32_t& value = uv->of_corner[corner];
      if (value == kNone || placement == TexturePlacement{}) continue;
      const auto [found, is_new] =
          placed.try_emplace({material, value}, static_cast<std::uint32_t>(uv->value_count()));
      for (std::size_t k = 0; is_new && k < 2; ++k) {
        uv->values.push_back(placement.scale[k] * uv->values[2 * value + k] + placement.offset[k]);
      }
      value = found->second;
    }
  }

  static constexpr std::size_t kMaxIgnoredWords = 8;

  const Source& source_;
  RawMesh raw_;
  FaceSink sink_;
  std::optional<Failure> failure_;
  std::size_t line_number_ = 0;
  std::size_t known_lines_ = 0, face_lines_ = 0, short_faces_ = 0, texcoords_with_depth_ = 0;

  std::vector<float> colors_, paint_, normals_, texcoords_;
  std::vector<std::uint32_t> texcoord_of_corner_, normal_of_corner_;
  std::array<bool, 3> has_orphans_{};                 // by kind
  std::array<std::size_t, 3> count_{};                // by kind: values before the line in hand
  std::array<std::vector<std::uint32_t>, 3> corner_;  // by kind: the face in hand

  bool has_smoothing_groups_ = false;
  std::uint32_t smoothing_group_ = 0;
  std::optional<MaterialId> material_;
  std::string object_, group_;
  PartId part_{};
  bool part_is_known_ = false, names_parts_ = false;
  std::unordered_map<std::string, std::uint32_t> material_of_name_, part_of_name_;
  std::vector<std::string> libraries_;
  std::map<std::string, std::size_t, std::less<>> ignored_;
};

}  // namespace

Result<RawMesh> read_obj(const Source& source) {
  return ObjReader(source).read();
}

}  // namespace crease

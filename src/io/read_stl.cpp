// STL, binary and text. Binary is told by its size, 84 + 50 n, since binary files begin with
// "solid" too; where it has another size, cut or longer, by a zero byte, which no text has. Facet
// normals are not used: they are flat by definition, often zero, and say nothing that the winding
// does not; hard edges come from the crease angle.
#include "base/bytes.h"
#include "io/formats.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

double f32_at(std::span<const std::byte> bytes, std::size_t offset) {
  return static_cast<double>(std::bit_cast<float>(u32_at(bytes, offset)));
}

// What the writer here took off all positions (write_stl.cpp); of other files zero.
Vec3d origin_in(std::string_view header) {
  if (!header.starts_with(kStlHeader)) return {};
  header.remove_prefix(kStlHeader.size());
  if (!header.starts_with(kStlLess)) return {};
  header.remove_prefix(kStlLess.size());
  Line line{header.data(), header.data() + header.size()};
  Vec3d origin;
  for (int i = 0; i < 3; ++i) {
    if (!line.number(origin[i])) return {};
  }
  return origin;
}

// The colour of facets that have none of their own, if the header says COLOR= as Materialise's
// programs write it; then attribute bytes are colours of five bits a component.
std::optional<std::array<float, 3>> color_in(std::string_view header) {
  constexpr std::string_view kColorFollows = "COLOR=";
  const std::size_t at = header.find(kColorFollows);
  if (at == header.npos || at + kColorFollows.size() + 4 > header.size()) return {};
  std::array<float, 3> color{};
  for (std::size_t k = 0; k < 3; ++k) {
    color[k] =
        static_cast<float>(static_cast<unsigned char>(header[at + kColorFollows.size() + k])) / 255;
  }
  return color;
}

// Writers that know the colour of the whole alone leave all attributes 0, which would be black.
RawLayer colors_of(std::span<const std::uint16_t> attributes,
                   const std::array<float, 3>& of_others) {
  constexpr unsigned kNotItsOwn = 0x8000;
  const bool has_own = std::ranges::any_of(attributes, [](std::uint16_t a) { return a != 0; });
  RawLayer colors = color_layer(RawLayer::Per::Face, 3);
  for (const unsigned attribute : attributes) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float own = static_cast<float>(attribute >> (5 * k) & 31) / 31;
      colors.values.push_back(!has_own || (attribute & kNotItsOwn) != 0 ? of_others[k] : own);
    }
  }
  return colors;
}

void add_triangle(RawMesh& raw) {
  const auto first = static_cast<std::uint32_t>(raw.positions.size() - 3);
  raw.triangles.push_back({first, first + 1, first + 2});
}

Result<RawMesh> read_binary(const Source& source, std::size_t facet_count) {
  RawMesh raw;
  raw.report.format = "binary STL";
  raw.usual_up = UpAxis::Z;
  raw.positions.reserve(3 * facet_count);
  raw.triangles.reserve(facet_count);
  std::vector<std::uint16_t> attributes;
  const std::string_view header = source.text().substr(0, kHeaderBytes - 4);
  const Vec3d origin = origin_in(header);
  const std::optional<std::array<float, 3>> color = color_in(header);
  if (origin != Vec3d{}) raw.report.notes.push_back("moved by what its header says it is less");
  for (std::size_t f = 0; f < facet_count; ++f) {
    const std::size_t facet = kHeaderBytes + kFacetBytes * f;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = facet + 12 + 12 * c;
      const Vec3d p = origin + Vec3d{f32_at(source.bytes, at), f32_at(source.bytes, at + 4),
                                     f32_at(source.bytes, at + 8)};
      if (!is_position(p)) {
        return fail_at_byte(Error::BadValue, source, at,
                            "corner of facet " + std::to_string(f) + " is " + fault_of(p));
      }
      raw.positions.push_back(p);
    }
    add_triangle(raw);
    const auto low = std::to_integer<unsigned>(source.bytes[facet + 48]);
    const auto high = std::to_integer<unsigned>(source.bytes[facet + 49]);
    attributes.push_back(static_cast<std::uint16_t>(low | high << 8));
  }
  const bool has_attributes = std::ranges::any_of(attributes, [](auto a) { return a != 0; });
  if (color && facet_count > 0) {
    raw.layers.push_back(colors_of(attributes, *color));
    raw.report.notes.push_back(has_attributes ? "attribute bytes are colours, as its header says"
                                              : "all of the colour that its header has");
  } else if (has_attributes) {
    raw.layers.push_back({std::string(kStlAttribute),
                          AttributeRole::Other,
                          Interpolation::Categorical,
                          RawLayer::Per::Face,
                          1,
                          {attributes.begin(), attributes.end()},
                          {}});
  }
  if (source.bytes.size() > kHeaderBytes + kFacetBytes * facet_count) {
    raw.report.notes.push_back("bytes after the last facet ignored");
  }
  return raw;
}

std::string next_word(Line& line) {
  std::string word(line.word().substr(0, 16));
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

Result<RawMesh> read_text(const Source& source) {
  RawMesh raw;
  raw.report.format = "text STL";
  raw.usual_up = UpAxis::Z;
  LineReader lines(source.text());
  std::size_t corners = 0;
  bool in_facet = false, closed = true;
  Line line;
  while (lines.next(line)) {
    // A line may hold several statements: some writers put a whole facet on one.
    while (!line.done()) {
      std::string word = next_word(line);
      if (word == "end") word += next_word(line);  // "end solid", as Geomagic writes it
      const auto refuse = [&](Error error, const std::string& reason) {
        return fail_at_line(error, source, line.line_number, reason);
      };
      if (word == "solid") {
        raw.parts.emplace_back(line.rest());
        closed = false;
      } else if (word == "endsolid") {
        line.rest();
        closed = true;
      } else if (word == "facet") {
        if (in_facet) return refuse(Error::BadFormat, "a facet begins inside a facet");
        in_facet = true;
        corners = 0;
      } else if (word == "normal") {
        for (int i = 0; i < 3; ++i) line.word();
      } else if (word == "vertex") {
        Vec3d p;
        for (int i = 0; i < 3; ++i) {
          if (!line.number(p[i])) {
            return refuse(Error::BadFormat, "vertex: not a number: " + in_quotes(line.word()));
          }
        }
        if (!is_position(p)) {
          return refuse(Error::BadValue, std::string("vertex is ") + fault_of(p));
        }
        if (!in_facet || ++corners > 3)
          return refuse(Error::BadFormat, "vertex beyond a facet's three");
        raw.positions.push_back(p);
      } else if (word == "endfacet") {
        if (corners != 3) return refuse(Error::BadFormat, "a facet without three vertices");
        in_facet = false;
        corners = 0;
        add_triangle(raw);
        if (raw.parts.empty()) raw.parts.emplace_back();
        raw.part_of_triangle.push_back(PartId{static_cast<std::uint32_t>(raw.parts.size() - 1)});
      } else if (word != "outer" && word != "loop" && word != "endloop") {
        return refuse(Error::BadFormat, "not a word of STL: " + in_quotes(word));
      }
    }
  }
  if (in_facet || !closed) {
    return fail_at_line(Error::Truncated, source, line.line_number, "the file ends inside a solid");
  }
  if (raw.parts.size() == 1 && raw.parts[0].empty()) {
    raw.parts.clear();
    raw.part_of_triangle.clear();
  }
  return raw;
}

// In any case, after blanks and blank lines, as text readers take it.
bool says_solid(std::string_view text) {
  constexpr std::string_view kSolid = "solid";
  const std::size_t begin = text.find_first_not_of(" \t\r\n\v\f");
  if (begin == text.npos) return false;
  const std::string_view word = text.substr(begin, kSolid.size());
  return std::ranges::equal(word, kSolid, {}, [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
}

// Names of binary solids end in zeros or blanks; its counts and coordinates have zeros early on.
bool is_text(std::string_view text) {
  constexpr std::size_t kEarly = 1024;
  return says_solid(text) && text.substr(0, kEarly).find('\0') == text.npos;
}

}  // namespace

Result<RawMesh> read_stl(const Source& source) {
  const std::size_t size = source.bytes.size();
  const std::size_t promised = size >= kHeaderBytes ? u32_at(source.bytes, 80) : 0;
  const std::size_t needed = kHeaderBytes + kFacetBytes * promised;
  const bool is_binary = size >= kHeaderBytes && (needed == size || !is_text(source.text()));
  Result<RawMesh> raw = [&]() -> Result<RawMesh> {
    if (!is_binary) return read_text(source);
    if (needed > size) {
      return fail_at_byte(Error::Truncated, source, size,
                          "the header promises " + std::to_string(promised) + " facets, " +
                              std::to_string(needed) + " bytes");
    }
    return read_binary(source, promised);
  }();
  if (raw.ok()) raw->report.notes.push_back("facet normals not used: the winding says them");
  return raw;
}

}  // namespace crease

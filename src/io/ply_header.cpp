#include "io/ply_header.h"

#include "io/text.h"

#include <array>
#include <optional>
#include <utility>

namespace crease {

namespace {

constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};

std::optional<PlyType> type_named(std::string_view name) {
  constexpr std::pair<std::string_view, PlyType> kNames[] = {
      {"char", PlyType::Int8},       {"int8", PlyType::Int8},       {"uchar", PlyType::Uint8},
      {"uint8", PlyType::Uint8},     {"short", PlyType::Int16},     {"int16", PlyType::Int16},
      {"ushort", PlyType::Uint16},   {"uint16", PlyType::Uint16},   {"int", PlyType::Int32},
      {"int32", PlyType::Int32},     {"uint", PlyType::Uint32},     {"uint32", PlyType::Uint32},
      {"float", PlyType::Float32},   {"float32", PlyType::Float32}, {"double", PlyType::Float64},
      {"float64", PlyType::Float64},
  };
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

struct HeaderReader {
  const Source& source;
  PlyHeader header;
  std::optional<Failure> failure;
  std::size_t line_number = 0;

  bool refuse(Error error, const std::string& reason) {
    failure = fail_at_line(error, source, line_number, reason);
    return false;
  }

  bool read_format(Line& line) {
    const std::string_view word = line.word();
    if (word == "ascii") {
      header.encoding = PlyEncoding::Text;
    } else if (word == "binary_little_endian") {
      header.encoding = PlyEncoding::LittleEndian;
    } else if (word == "binary_big_endian") {
      header.encoding = PlyEncoding::BigEndian;
    } else {
      return refuse(Error::BadFormat, "unknown PLY format " + in_quotes(word));
    }
    return true;
  }

  bool read_element(Line& line) {
    PlyElement element;
    element.name = line.word();
    std::int64_t count = 0;
    if (element.name.empty() || !line.integer(count) || count < 0) {
      return refuse(Error::BadFormat, "element without a name and a count");
    }
    for (const PlyElement& before : header.elements) {
      if (before.name == element.name) {
        return refuse(Error::BadFormat, "a second element " + in_quotes(element.name));
      }
    }
    element.count = static_cast<std::size_t>(count);
    header.elements.push_back(std::move(element));
    return true;
  }

  bool read_property(Line& line) {
    if (header.elements.empty()) return refuse(Error::BadFormat, "property before any element");
    PlyProperty property;
    std::string_view word = line.word();
    if (word == "list") {
      property.is_list = true;
      const std::optional<PlyType> type = type_named(line.word());
      if (!type || !is_integer(*type)) return refuse(Error::BadFormat, "list without a count type");
      property.count_type = *type;
      word = line.word();
    }
    const std::optional<PlyType> type = type_named(word);
    if (!type) return refuse(Error::BadFormat, "unknown property type " + in_quotes(word));
    property.type = *type;
    property.name = line.rest();
    if (property.name.empty()) return refuse(Error::BadFormat, "property without a name");
    header.elements.back().properties.push_back(std::move(property));
    return true;
  }

  bool read() {
    LineReader lines = LineReader::ending_like_first(source.text());
    Line line;
    bool has_format = false;
    while (lines.next(line)) {
      line_number = line.line_number;
      const std::string_view word = line.word();
      if (line_number == 1) {
        if (word != "ply") return refuse(Error::BadFormat, "does not begin with 'ply'");
      } else if (word == "format") {
        has_format = true;
        if (!read_format(line)) return false;
      } else if (word == "element") {
        if (!read_element(line)) return false;
      } else if (word == "property") {
        if (!read_property(line)) return false;
      } else if (word == "comment") {
        header.comments.emplace_back(line.rest());
      } else if (word == "end_header") {
        header.byte_count = static_cast<std::size_t>(lines.position() - source.text().data());
        header.line_count = line_number;
        if (!has_format) return refuse(Error::BadFormat, "header without a format line");
        return true;
      } else if (word != "obj_info" && !word.empty()) {
        header.unknown_words.emplace_back(
            word);  // older exporters wrote comments without 'comment'
      }
    }
    return refuse(Error::Truncated, "the header has no end_header");
  }
};

}  // namespace

std::size_t size_of(PlyType type) {
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::least_bytes(bool is_text) const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) {
    bytes += is_text ? 2 : size_of(p.is_list ? p.count_type : p.type);
  }
  return bytes;
}

Result<PlyHeader> read_ply_header(const Source& source) {
  HeaderReader reader{source, {}, {}, 0};
  if (!reader.read()) return *reader.failure;
  return std::move(reader.header);
}

}  // namespace crease

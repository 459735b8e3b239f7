// The numbers after a PLY header, one after another, whatever the encoding.
//
//   PlyBody body(source, header);
//   if (!body.begin_row()) ...                   // text: the next line
//   if (double x; !body.number(PlyType::Float32, x)) ... body.problem() says what is wrong
#pragma once

#include "io/ply_header.h"
#include "io/text.h"

#include <bit>
#include <cstring>
#include <span>

namespace crease {

class PlyBody {
 public:
  PlyBody(const Source& source, const PlyHeader& header)
      : source_(source),
        encoding_(header.encoding),
        offset_(header.byte_count),
        header_lines_(header.line_count),
        lines_(source.text().substr(header.byte_count)) {}

  bool is_text() const { return encoding_ == PlyEncoding::Text; }

  // Bytes that are left.
  std::size_t left() const {
    const auto read = static_cast<std::size_t>(lines_.position() - source_.text().data());
    return source_.bytes.size() - (is_text() ? read : offset_);
  }

  // Text has one row a line; blank lines are passed over.
  bool begin_row() {
    if (!is_text()) return true;
    while (lines_.next(line_)) {
      if (!line_.done()) return true;
    }
    line_ = {nullptr, nullptr, line_.line_number + 1};
    return false;
  }
  // Whether the row holds more than was read from it.
  bool row_has_more() { return is_text() && !line_.done(); }

  // Whether anything but blank lines follows the last row.
  bool has_more_rows() { return is_text() ? begin_row() : left() > 0; }

  bool number(PlyType type, double& x) {
    if (is_text()) return line_.number(x);
    const std::size_t size = size_of(type);
    if (size > source_.bytes.size() - offset_) return false;
    const std::byte* at = source_.bytes.data() + offset_;
    offset_ += size;
    switch (type) {
      case PlyType::Int8:
        x = static_cast<std::int8_t>(*at);
        break;
      case PlyType::Uint8:
        x = static_cast<std::uint8_t>(*at);
        break;
      case PlyType::Int16:
        x = static_cast<std::int16_t>(load<std::uint16_t>(at));
        break;
      case PlyType::Uint16:
        x = load<std::uint16_t>(at);
        break;
      case PlyType::Int32:
        x = static_cast<std::int32_t>(load<std::uint32_t>(at));
        break;
      case PlyType::Uint32:
        x = load<std::uint32_t>(at);
        break;
      case PlyType::Float32:
        x = static_cast<double>(std::bit_cast<float>(load<std::uint32_t>(at)));
        break;
      case PlyType::Float64:
        x = std::bit_cast<double>(load<std::uint64_t>(at));
        break;
    }
    return true;
  }

  // At the number that number() could not read, or read last.
  Failure refuse(Error error, const std::string& reason) const {
    if (is_text()) return fail_at_line(error, source_, header_lines_ + line_.line_number, reason);
    return fail_at_byte(error, source_, offset_, reason);
  }
  // Why number() or begin_row() failed, in the row of what `what` names.
  Failure problem(const std::string& what) {
    if (!is_text() || line_.at == nullptr) {
      return refuse(Error::Truncated, "the file ends in " + what);
    }
    if (line_.done()) return refuse(Error::Truncated, what + " has too few numbers");
    return refuse(Error::BadFormat, what + ": not a number: " + in_quotes(line_.word()));
  }

 private:
  template <typename Bits>
  Bits load(const std::byte* at) const {
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof(Bits); ++i) {
      const std::size_t shift =
          8 * (encoding_ == PlyEncoding::LittleEndian ? i : sizeof(Bits) - 1 - i);
      bits = static_cast<Bits>(bits | static_cast<Bits>(std::to_integer<Bits>(at[i]) << shift));
    }
    return bits;
  }

  const Source& source_;
  PlyEncoding encoding_;
  std::size_t offset_;        // binary
  std::size_t header_lines_;  // text
  LineReader lines_;
  Line line_;
};

}  // namespace crease

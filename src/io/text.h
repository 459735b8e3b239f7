// Text read line by line and number by number, without copies: what OBJ, PLY, STL and OFF share.
//
//   LineReader lines(text);
//   for (Line line; lines.next(line);) {
//     const std::string_view word = line.word();
//     double x;
//     if (!line.number(x)) return fail_at_line(Error::BadFormat, source, line.number_in_file, ...);
//   }
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include <fast_float/fast_float.h>

namespace crease {

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// What is left of one line.
struct Line {
  const char* at = nullptr;
  const char* end = nullptr;
  std::size_t line_number = 0;  // of its first character; from 1

  void skip_blanks() {
    while (at != end && is_blank(*at)) ++at;
  }
  // Nothing but blanks is left.
  bool done() {
    skip_blanks();
    return at == end;
  }
  // The next word; empty at the end.
  std::string_view word() {
    skip_blanks();
    const char* begin = at;
    while (at != end && !is_blank(*at)) ++at;
    return {begin, static_cast<std::size_t>(at - begin)};
  }
  // The rest without blanks around it.
  std::string_view rest() {
    skip_blanks();
    const char* last = end;
    while (last != at && is_blank(last[-1])) --last;
    const std::string_view text(at, static_cast<std::size_t>(last - at));
    at = end;
    return text;
  }
  // A number and the blank behind it. "nan" and "inf" are numbers here, and so is what older
  // Microsoft libraries write for them. False leaves `at` before what is not a number.
  bool number(double& x) {
    skip_blanks();
    const char* begin = at != end && *at == '+' ? at + 1 : at;
    if (begin != at && begin != end && *begin == '-') return false;
    const fast_float::from_chars_result got = fast_float::from_chars(begin, end, x);
    if (got.ec != std::errc()) return false;
    const char* behind = got.ptr;
    if (behind != end && *behind == '#') behind = not_finite(behind, x);
    if (behind != end && !is_blank(*behind)) return false;
    at = behind;
    return true;
  }
  bool integer(std::int64_t& x) {
    skip_blanks();
    const char* begin = at != end && *at == '+' ? at + 1 : at;
    const std::from_chars_result got = std::from_chars(begin, end, x);
    if (got.ec != std::errc() || (got.ptr != end && !is_blank(*got.ptr))) return false;
    at = got.ptr;
    return true;
  }

 private:
  // "1.#INF", "-1.#IND00", "1.#QNAN0": what is behind it, or `hash` if it is none of these.
  const char* not_finite(const char* hash, double& x) const {
    const std::string_view text(hash, static_cast<std::size_t>(end - hash));
    const bool is_infinite = text.starts_with("#INF");
    const bool is_nan =
        text.starts_with("#IND") || text.starts_with("#QNAN") || text.starts_with("#SNAN");
    if (!is_infinite && !is_nan) return hash;
    x = is_nan  ? std::numeric_limits<double>::quiet_NaN()
        : x < 0 ? -std::numeric_limits<double>::infinity()
                : std::numeric_limits<double>::infinity();
    const char* behind = hash + (text[1] == 'I' ? 4 : 5);
    while (behind != end && *behind == '0') ++behind;
    return behind;
  }
};

// Lines that end in "\n" or "\r\n", or with the text; in a text without "\n", in "\r".
class LineReader {
 public:
  // With `backslash_continues`, a line whose last character is a backslash goes on in the next.
  explicit LineReader(std::string_view text, bool backslash_continues = false)
      : LineReader(text, text.find('\n') == text.npos ? '\r' : '\n', backslash_continues) {}

  // For text that something else follows: lines end as the first one does.
  static LineReader ending_like_first(std::string_view text) {
    const std::size_t end = text.find_first_of("\r\n");
    const std::size_t behind = text.find_first_not_of('\r', end);
    const bool has_newline = end == text.npos || (behind != text.npos && text[behind] == '\n');
    return LineReader(text, has_newline ? '\n' : '\r', false);
  }

  bool next(Line& line) {
    if (at_ == end_) return false;
    line.line_number = ++line_number_;
    line.at = at_;
    line.end = take();
    if (continues_ && ends_in_backslash(line.at, line.end)) join(line);
    return true;
  }
  // The first character after the line last read.
  const char* position() const { return at_; }

 private:
  LineReader(std::string_view text, char line_end, bool backslash_continues)
      : at_(text.data()),
        end_(text.data() + text.size()),
        line_end_(line_end),
        continues_(backslash_continues) {}

  const char* take() {
    const void* found = std::memchr(at_, line_end_, static_cast<std::size_t>(end_ - at_));
    const char* line_end = found ? static_cast<const char*>(found) : end_;
    at_ = found ? line_end + 1 : end_;
    return line_end;
  }
  static bool ends_in_backslash(const char* begin, const char*& end) {
    const char* last = end;
    if (last != begin && last[-1] == '\r') --last;
    if (last == begin || last[-1] != '\\') return false;
    end = last - 1;
    return true;
  }
  void join(Line& line) {
    joined_.assign(line.at, line.end);
    bool more = true;
    while (more && at_ != end_) {
      const char* begin = at_;
      const char* line_end = take();
      ++line_number_;
      more = ends_in_backslash(begin, line_end);
      joined_ += ' ';
      joined_.append(begin, line_end);
    }
    line.at = joined_.data();
    line.end = joined_.data() + joined_.size();
  }

  const char* at_;
  const char* end_;
  char line_end_;
  bool continues_;
  std::size_t line_number_ = 0;
  std::string joined_;
};

// A piece of the file for a message: quoted, not longer than 40 characters. What is no UTF-8, and
// control characters, are '?'.
std::string in_quotes(std::string_view text);

}  // namespace crease

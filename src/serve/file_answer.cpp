#include "serve/file_answer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>

namespace crease::serve {

namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// Numbers beyond 64 bits are beyond every file.
std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end != text.data() + text.size()) return {};
  if (error == std::errc::result_out_of_range) return UINT64_MAX;
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

struct Part {
  std::uint64_t offset = 0, bytes = 0;  // no bytes: none of it is there
};

// Of "bytes=0-499", "bytes=500-", "bytes=-500". Nothing where the field is to be ignored: another
// unit, several ranges, no range at all.
std::optional<Part> parse_range(std::string_view text, std::uint64_t file_bytes) {
  constexpr std::string_view kUnit = "bytes=";  // in any case (RFC 9110 14.1)
  const auto is_same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  };
  if (!std::ranges::equal(text.substr(0, kUnit.size()), kUnit, is_same)) return {};
  text = trimmed(text.substr(kUnit.size()));
  const std::size_t dash = text.find('-');
  if (dash == std::string_view::npos) return {};
  const std::string_view from = text.substr(0, dash), to = text.substr(dash + 1);
  if (from.empty()) {
    const std::optional<std::uint64_t> count = number(to);
    if (!count) return {};
    const std::uint64_t bytes = std::min(*count, file_bytes);
    return Part{file_bytes - bytes, bytes};
  }
  const std::optional<std::uint64_t> first = number(from);
  const std::optional<std::uint64_t> last = to.empty() ? UINT64_MAX : number(to);
  if (!first || !last || *last < *first) return {};
  if (*first >= file_bytes) return Part{};
  return Part{*first, std::min(*last, file_bytes - 1) - *first + 1};
}

// If-None-Match compares weakly: W/"x" is "x".
bool names(std::string_view list, std::string_view etag) {
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    std::string_view one = trimmed(list.substr(0, comma));
    if (one.starts_with("W/")) one.remove_prefix(2);
    if (one == "*" || one == etag) return true;
    list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1);
  }
  return false;
}

}  // namespace

FileAnswer answer_for(const FileFacts& file, const RequestFields& fields) {
  const bool is_unchanged =
      fields.if_none_match.empty()
          ? !fields.if_modified_since.empty() && fields.if_modified_since == file.last_modified
          : names(fields.if_none_match, file.etag);
  if (is_unchanged) return {304, 0, 0, {}};

  FileAnswer whole{200, 0, file.bytes, {}};
  const bool is_the_one_meant = fields.if_range.empty() || fields.if_range == file.etag ||
                                fields.if_range == file.last_modified;
  if (fields.range.empty() || !is_the_one_meant) return whole;
  const std::optional<Part> part = parse_range(fields.range, file.bytes);
  if (!part) return whole;
  const std::string size = std::to_string(file.bytes);
  if (part->bytes == 0) return {416, 0, 0, "bytes */" + size};
  return {206, part->offset, part->bytes,
          "bytes " + std::to_string(part->offset) + "-" +
              std::to_string(part->offset + part->bytes - 1) + "/" + size};
}

std::string http_date(std::time_t seconds) {
  constexpr std::array kDays = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                  "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  std::tm t{};
  gmtime_r(&seconds, &t);
  char text[64];
  std::snprintf(text, sizeof text, "%s, %02d %s %d %02d:%02d:%02d GMT",
                kDays[static_cast<std::size_t>(t.tm_wday)], t.tm_mday,
                kMonths[static_cast<std::size_t>(t.tm_mon)], t.tm_year + 1900, t.tm_hour, t.tm_min,
                t.tm_sec);
  return text;
}

}  // namespace crease::serve

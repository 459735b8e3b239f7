#include "http/response_reader.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace crease::http {

namespace {

constexpr std::uint64_t kNoEnd = std::numeric_limits<std::uint64_t>::max();

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

template <typename Number>
std::optional<Number> all_digits(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

struct ContentRange {
  std::optional<std::uint64_t> first, last;  // neither: of a 416
  std::optional<std::uint64_t> size;         // nothing: '*'
};

// "bytes 0-499/1234", "bytes 0-499/*", "bytes */1234".
std::optional<ContentRange> parse_content_range(std::string_view text) {
  if (text.size() < 6 || !is_same_word(text.substr(0, 5), "bytes") || text[5] != ' ') return {};
  text = trimmed(text.substr(6));
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return {};
  ContentRange range;
  const std::string_view size = text.substr(slash + 1), span = text.substr(0, slash);
  if (size != "*") {
    range.size = all_digits<std::uint64_t>(size);
    if (!range.size) return {};
  }
  if (span == "*") return range;
  const std::size_t dash = span.find('-');
  if (dash == std::string_view::npos) return {};
  range.first = all_digits<std::uint64_t>(span.substr(0, dash));
  range.last = all_digits<std::uint64_t>(span.substr(dash + 1));
  const bool is_sound = range.first && range.last && *range.first <= *range.last &&
                        *range.last < kNoEnd && (!range.size || *range.last < *range.size);
  if (!is_sound) return {};
  return range;
}

// RFC 9110 15: what may be different the next time.
bool is_passing(int status) {
  return status == 408 || status == 425 || status == 429 || status == 500 || status == 502 ||
         status == 503 || status == 504;
}

bool is_redirect(int status) {
  return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

std::string_view without_weakness(std::string_view etag) {
  return etag.substr(0, 2) == "W/" ? etag.substr(2) : etag;
}

std::uint64_t end_of(const FileRange& range) {
  return range.offset + std::min(range.bytes, kNoEnd - range.offset);
}

}  // namespace

std::string_view Identity::validator() const {
  if (!etag.empty() && etag.front() == '"') return etag;
  return last_modified;
}

std::string difference(const Identity& before, const Identity& now) {
  if (before.size && now.size && *before.size != *now.size) {
    return "it had " + std::to_string(*before.size) + " bytes and has " + std::to_string(*now.size);
  }
  if (!before.etag.empty() && !now.etag.empty()) {
    if (without_weakness(before.etag) == without_weakness(now.etag)) return {};
    return "its ETag was " + before.etag + " and is " + now.etag;
  }
  if (!before.last_modified.empty() && !now.last_modified.empty() &&
      before.last_modified != now.last_modified) {
    return "it was of " + before.last_modified + " and is of " + now.last_modified;
  }
  return {};
}

ResponseReader::ResponseReader(const FileRange& asked, const Identity* known)
    : asked_(asked), known_(known) {}

void ResponseReader::on_header(std::string_view line) {
  if (line.substr(0, 5) == "HTTP/") {
    *this = ResponseReader(asked_, known_);
    const std::size_t space = line.find(' ');
    if (space != std::string_view::npos) {
      status_ = all_digits<std::uint16_t>(trimmed(line.substr(space + 1)).substr(0, 3)).value_or(0);
    }
    return;
  }
  if (state_ != State::Header) return;  // trailers
  if (trimmed(line).empty()) return judge();
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;
  on_field(line.substr(0, colon), trimmed(line.substr(colon + 1)));
}

void ResponseReader::on_field(std::string_view name, std::string_view value) {
  if (is_same_word(name, "content-range")) content_range_ = value;
  if (is_same_word(name, "content-encoding")) content_encoding_ = value;
  if (is_same_word(name, "content-length")) content_length_ = all_digits<std::uint64_t>(value);
  if (is_same_word(name, "retry-after")) retry_after_s_ = all_digits<std::uint32_t>(value);
  if (is_same_word(name, "etag")) identity_.etag = value;
  if (is_same_word(name, "last-modified")) identity_.last_modified = value;
}

void ResponseReader::judge() {
  if (status_ >= 100 && status_ < 200) return;  // another status line follows
  if (status_ == 206) return judge_part();
  if (status_ == 200) return judge_whole();
  if (status_ == 416) return judge_unsatisfiable();
  const std::string status = "the host answers with status " + std::to_string(status_);
  if (is_passing(status_)) return ask_again(status);
  const bool is_gone = status_ == 404 || status_ == 410;
  refuse(is_gone ? Error::NotFound : Error::ReadFailed, status);
}

// 206.
void ResponseReader::judge_part() {
  const std::optional<ContentRange> range = parse_content_range(content_range_);
  if (!range || !range->first) {
    return refuse(Error::ReadFailed,
                  "the host answers with a part and does not say which: "
                  "Content-Range \"" +
                      content_range_ + "\"");
  }
  identity_.size = range->size;
  if (!is_known_file()) return;
  if (!range->size && !known_) {
    return refuse(
        Error::ReadFailed,
        "the host does not say how long the file is: Content-Range \"" + content_range_ + "\"");
  }
  if (*range->first != asked_.offset) {
    return refuse(Error::ReadFailed, "bytes from " + std::to_string(asked_.offset) +
                                         " on were asked for, the host answers with \"" +
                                         content_range_ + "\"");
  }
  const std::uint64_t end = std::min(*range->last + 1, end_of(asked_));
  will_give_ = end - asked_.offset;
  ends_the_file_ = range->size && end == *range->size;
  state_ = State::Body;
}

// 200: the host ignores ranges, or thinks that the file is another one than If-Range says.
void ResponseReader::judge_whole() {
  identity_.size = content_length_;
  if (!is_known_file()) return;
  if (!identity_.size && known_) identity_.size = known_->size;
  skip_ = asked_.offset;
  if (identity_.size && *identity_.size < asked_.offset) {
    return refuse(Error::ReadFailed, "the host has fewer bytes than it said");
  }
  const std::uint64_t end = std::min(identity_.size.value_or(kNoEnd), end_of(asked_));
  will_give_ = end - asked_.offset;
  ends_the_file_ = identity_.size && end == *identity_.size;
  state_ = State::Body;
}

// 416: a file without bytes, or one that became shorter.
void ResponseReader::judge_unsatisfiable() {
  if (const std::optional<ContentRange> range = parse_content_range(content_range_)) {
    identity_.size = range->size;
  }
  if (!is_known_file()) return;
  if (!known_ && identity_.size == 0) {
    ends_the_file_ = true;
    state_ = State::Body;
    return;
  }
  refuse(Error::ReadFailed, "the host has no bytes from " + std::to_string(asked_.offset) +
                                " on (status 416, Content-Range \"" + content_range_ + "\")");
}

bool ResponseReader::is_known_file() {
  if (!content_encoding_.empty() && !is_same_word(content_encoding_, "identity")) {
    refuse(Error::NotSupported, "the host sends it compressed (Content-Encoding " +
                                    content_encoding_ +
                                    "), where ranges mean nothing; switch that off for .crease");
    return false;
  }
  if (!known_) return true;
  const std::string why = difference(*known_, identity_);
  if (why.empty()) return true;
  refuse(Error::Replaced, "the file was replaced while it was read: " + why + "; open it again");
  return false;
}

void ResponseReader::refuse(Error error, std::string why) {
  verdict_ = {Verdict::Kind::Refused, fail(error, std::move(why)), {}};
  state_ = State::Over;
}

void ResponseReader::ask_again(std::string why) {
  verdict_ = {Verdict::Kind::Again, fail(Error::ReadFailed, std::move(why)), retry_after_s_};
  state_ = State::Over;
}

std::span<const std::byte> ResponseReader::on_body(std::span<const std::byte> chunk) {
  if (state_ != State::Body) return {};
  const std::uint64_t skipped = std::min<std::uint64_t>(skip_, chunk.size());
  skip_ -= skipped;
  chunk = chunk.subspan(static_cast<std::size_t>(skipped));
  chunk = chunk.first(static_cast<std::size_t>(std::min<std::uint64_t>(missing(), chunk.size())));
  given_ += chunk.size();
  return chunk;
}

Verdict ResponseReader::finish(bool was_cut) const {
  if (state_ == State::Over && was_cut && is_redirect(status_)) {
    return {Verdict::Kind::Again, verdict_.failure, {}};  // of where it led to nothing came
  }
  if (state_ == State::Over) return verdict_;
  if (state_ == State::Header) {
    return {Verdict::Kind::Again, fail(Error::ReadFailed, "the host gave no answer"), {}};
  }
  // A whole file whose length was not said ends where it ends.
  const bool has_no_length = status_ == 200 && !identity_.size && !was_cut;
  if (missing() > 0 && !has_no_length) {
    return {Verdict::Kind::Again,
            fail(Error::ReadFailed, "the answer ended after " + std::to_string(given_) + " of " +
                                        std::to_string(will_give_) + " bytes"),
            {}};
  }
  const bool is_all = given_ == asked_.bytes || ends_the_file_ || has_no_length;
  return {is_all ? Verdict::Kind::Complete : Verdict::Kind::Partial, {}, {}};
}

}  // namespace crease::http

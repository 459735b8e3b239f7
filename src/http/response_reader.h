// What a host's answer to a request for a range means: header lines and bytes of the body in, the
// bytes that were asked for and a verdict out. Knows no connection, so that tests and the fuzzer
// can say what a host says.
//
//   ResponseReader reader({65536, 1000}, known);
//   reader.on_header("HTTP/1.1 206 Partial Content\r\n"); ... reader.on_header("\r\n");
//   wanted = reader.on_body(chunk);            // what of the chunk was asked for
//   if (!reader.wants_more()) ...              // the rest of the answer is of no use
//   const Verdict verdict = reader.finish(was_cut);
//
// RFC 9110: 13.1.5 If-Range, 14 range requests, 15.3.7 (206), 15.5.17 (416).
#pragma once

#include "crease/byte_source.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace crease::http {

// Which version of a file it is. Of the first answer; every later one is compared with it.
struct Identity {
  std::string etag, last_modified;    // as they were sent; empty: not at all
  std::optional<std::uint64_t> size;  // of the whole file

  // For If-Range: a strong ETag, else the date, else empty.
  std::string_view validator() const;
};

// Why `now` is not what `before` was, or empty. What one of them does not tell is not compared.
std::string difference(const Identity& before, const Identity& now);

struct Verdict {
  enum class Kind {
    Complete,  // all of the range is there, or all of the file that is within it
    Partial,   // right as far as it goes: ask for the rest
    Again,     // nothing is wrong with the question: ask later
    Refused,   // asking again would not help
  };
  Kind kind = Kind::Refused;
  Failure failure{};  // of Again and Refused: the reason
  // Of Again: what the host asks for, in seconds.
  std::optional<std::uint32_t> retry_after_s{};
};

class ResponseReader {
 public:
  // `known`: of an answer before, or nullptr for the first one. A range may reach beyond the end of
  // the file then.
  ResponseReader(const FileRange& asked, const Identity* known);

  // A line with its end, as it came. A status line starts anew, as redirects and 100 do; the empty
  // line ends the header.
  void on_header(std::string_view line);
  // The part of `chunk` that was asked for. Those parts together are the range from its begin on.
  std::span<const std::byte> on_body(std::span<const std::byte> chunk);

  // False once nothing that may still come is of use.
  bool wants_more() const { return state_ == State::Header || missing() > 0; }
  // 200 instead of 206: the host ignores ranges, and the answer is all of the file.
  bool is_whole_file() const { return state_ == State::Body && status_ == 200; }
  const Identity& identity() const { return identity_; }  // after the header

  // The header is there, and what it says is an answer to what was asked.
  bool is_answer() const { return state_ == State::Body; }
  bool is_over() const { return state_ == State::Over; }

  // When the answer has ended. `was_cut`: it ended before it should.
  Verdict finish(bool was_cut) const;

 private:
  enum class State { Header, Body, Over };

  void on_field(std::string_view name, std::string_view value);
  void judge();
  void judge_part();
  void judge_whole();
  void judge_unsatisfiable();
  bool is_known_file();
  void refuse(Error error, std::string why);
  void ask_again(std::string why);
  std::uint64_t missing() const { return state_ == State::Body ? will_give_ - given_ : 0; }

  FileRange asked_;
  const Identity* known_;

  State state_ = State::Header;
  int status_ = 0;
  std::string content_range_, content_encoding_;
  std::optional<std::uint64_t> content_length_;
  std::optional<std::uint32_t> retry_after_s_;
  Identity identity_;

  std::uint64_t skip_ = 0;       // bytes of the body before what was asked
  std::uint64_t will_give_ = 0;  // bytes of the range that this answer has
  std::uint64_t given_ = 0;
  bool ends_the_file_ = false;  // what it has reaches the end
  Verdict verdict_;             // of State::Over
};

}  // namespace crease::http

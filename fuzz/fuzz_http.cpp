// What a host answers: header lines up to the first empty one, then the body, in chunks. Whatever
// it says, no more is taken than was asked for, and what counts as complete is.
#include "http/response_reader.h"

#include "base/assert.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

using crease::FileRange;
using crease::http::Identity;
using crease::http::ResponseReader;
using crease::http::Verdict;

namespace {

void check(const FileRange& asked, const Identity* known, std::string_view text, bool was_cut) {
  ResponseReader reader(asked, known);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end == text.npos ? end : end + 1);
    text.remove_prefix(line.size());
    reader.on_header(line);
    if (line == "\r\n" && !text.starts_with("HTTP/")) break;
  }
  std::uint64_t given = 0;
  while (!text.empty()) {
    const std::size_t bytes = 1 + static_cast<unsigned char>(text.front()) % text.size();
    const auto chunk = std::as_bytes(std::span(text.data(), bytes));
    const std::span<const std::byte> wanted = reader.on_body(chunk);
    CREASE_ASSERT(wanted.empty() || (wanted.data() >= chunk.data() &&
                                     wanted.data() + wanted.size() <= chunk.data() + bytes));
    given += wanted.size();
    text.remove_prefix(bytes);
  }
  CREASE_ASSERT(given <= asked.bytes);
  const Verdict verdict = reader.finish(was_cut);
  switch (verdict.kind) {
    case Verdict::Kind::Complete:
      // Without a known file the range may reach beyond its end.
      CREASE_ASSERT(known == nullptr || given == asked.bytes || !known->size ||
                    asked.offset + given == *known->size);
      CREASE_ASSERT(reader.is_answer());
      break;
    case Verdict::Kind::Partial:
      CREASE_ASSERT(given < asked.bytes && given > 0);
      break;
    case Verdict::Kind::Again:
    case Verdict::Kind::Refused:
      CREASE_ASSERT(!verdict.failure.message.empty());
      break;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Identity known{"\"one\"", "Sun, 06 Nov 1994 08:49:37 GMT", 1000};
  for (const bool was_cut : {false, true}) {
    check({0, 65536}, nullptr, text, was_cut);
    check({0, 10}, &known, text, was_cut);
    check({990, 10}, &known, text, was_cut);
  }
  return 0;
}

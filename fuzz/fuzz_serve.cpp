// What a client asks of `crease serve`: a path, then the fields Range, If-Range and If-None-Match,
// a line each. No path leads out of the folder, and no part out of the file.
#include "serve/file_answer.h"
#include "serve/open_below.h"

#include "base/assert.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  std::array<std::string_view, 4> lines;
  for (std::string_view& line : lines) {
    const std::size_t end = text.find('\n');
    line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
  }
  if (const auto path = crease::serve::parse_url_path(lines[0])) {
    for (const std::string& name : path->names) {
      CREASE_ASSERT(!name.empty() && name.front() != '.');
      CREASE_ASSERT(name.find('/') == name.npos && name.find('\0') == name.npos);
    }
  }
  for (const std::uint64_t bytes :
       {std::uint64_t(0), std::uint64_t(1), std::uint64_t(1000), std::uint64_t(1) << 62}) {
    const crease::serve::FileAnswer answer = crease::serve::answer_for(
        {bytes, "\"e\"", "date"},
        {.range = lines[1], .if_range = lines[2], .if_none_match = lines[3]});
    CREASE_ASSERT(answer.offset <= bytes && answer.bytes <= bytes - answer.offset);
    CREASE_ASSERT((answer.status == 206) == (answer.content_range.find('-') != std::string::npos));
    CREASE_ASSERT(answer.status != 206 || answer.bytes > 0);
    CREASE_ASSERT(answer.status != 200 || answer.bytes == bytes);
  }
  return 0;
}

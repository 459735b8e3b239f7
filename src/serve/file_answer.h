// What a request for a file is answered with, as RFC 9110 has it: all of it, a part, that it has
// not changed, or that there is no such part. Pure, for tests.
#pragma once

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>

namespace crease::serve {

struct FileFacts {
  std::uint64_t bytes = 0;
  std::string etag, last_modified;
};

// As they were sent; empty: not at all.
struct RequestFields {
  std::string_view range{}, if_range{}, if_none_match{}, if_modified_since{};
};

struct FileAnswer {
  int status = 200;                     // 200, 206, 304, 416
  std::uint64_t offset = 0, bytes = 0;  // of the body
  std::string content_range;            // of 206 and 416
};

FileAnswer answer_for(const FileFacts& file, const RequestFields& fields);

// "Sun, 06 Nov 1994 08:49:37 GMT", in any locale.
std::string http_date(std::time_t seconds);

}  // namespace crease::serve

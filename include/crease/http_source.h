// A file on a static host, read by HTTP range requests: blocking, or asynchronously.
//
//   Result<ByteSourcePtr> source = open_http_source("https://host/city.crease");
//   Result<BlockFile> file = BlockFile::open(*source);        // out of the first 64 KiB
//   (*source)->bytes_read();                                  // transferred so far
//
//   AsyncSourcePtr source = open_async_http("https://host/city.crease");   // returns at once
//   const Ticket ticket = source->request({entry.offset, entry.bytes});
//
// The first request brings 64 KiB and the file's size; they are kept, so head, tables, the first
// page and the coarse blocks take no other one. Connections stay open; over HTTPS requests share
// one by HTTP/2 where the host can. A file that is replaced while it is read is noticed by its
// size, its ETag or, without one, its date, and fails with Replaced; without either, checksums of
// blocks remain. Where the host ignores ranges the file is read from its begin on, as far as it is
// asked for, and kept: coarse blocks come first there too.
//
// What may pass is asked again, with growing pauses: no connection, one that broke (from where it
// broke on), too slow, statuses 408, 425, 429, 500, 502, 503 and 504. Every failure names the URL,
// without user and query, and the reason.
//
// Needs crease::crease. Proxies are those of the environment (http_proxy, no_proxy), as with curl.
#pragma once

#include "crease/async_source.h"
#include "crease/byte_source.h"
#include "crease/result.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace crease {

struct HttpOptions {
  AsyncOptions async{.max_in_flight = 6};
  std::chrono::milliseconds connect_timeout{10'000};
  // Fewer bytes a second over so many seconds: the connection counts as broken.
  std::uint32_t low_speed_bytes = 1000, low_speed_seconds = 10;
  // Attempts after the first one, since the last byte that came.
  int max_retries = 4;
  // Before the first of them; each further one waits twice as long, up to max_pause. A host's
  // Retry-After is obeyed up to max_pause.
  std::chrono::milliseconds first_pause{250}, max_pause{8000};
  // Of a file whose host ignores ranges.
  std::uint64_t max_whole_bytes = std::uint64_t(1) << 30;
  // Blocking: what was transferred is kept for another read, up to so many bytes.
  std::uint64_t keep_bytes = std::uint64_t(256) << 20;
  // Blocking: asked ten times a second while a read waits; true ends it with Interrupted.
  std::function<bool()> stopped{};
  std::string ca_file;  // PEM of authorities to trust; empty: the system's
};

// Begins with http:// or https://.
bool is_http_url(std::string_view text);

// Waits for the first answer. Reading from several threads is fine and goes on at the same time.
Result<ByteSourcePtr> open_http_source(const std::string& url, const HttpOptions& options = {});

// Never waits. Whether there is such a file the first answer tells; while there is not, each new
// request asks again.
AsyncSourcePtr open_async_http(const std::string& url, const HttpOptions& options = {});

}  // namespace crease

// HTTP requests to one URL through libcurl, any number at a time, all of them driven by one thread.
//
//   Transport transport(url, options);
//   transport.start(exchange, "0-65535", etag);
//   while (...) transport.run(timeout);        // calls the exchanges
//
// Threads: one, but for wake().
#pragma once

#include "crease/http_source.h"

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace crease::http {

// What an answer leads to.
class Exchange {
 public:
  enum class Flow {
    Go,
    Pause,  // the chunk was not taken and comes again after resume()
    Stop,   // no more is wanted
  };

  virtual void on_header(std::string_view line) = 0;
  virtual Flow on_body(std::span<const std::byte> chunk) = 0;
  // Last: the answer is complete (no problem), was stopped, or there is a problem, which may be
  // over the next time.
  virtual void on_end(const std::string& problem, bool may_pass) = 0;

 protected:
  ~Exchange() = default;
};

class Transport {
 public:
  Transport(std::string url, const HttpOptions& options);
  ~Transport();
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  // `range` as in the field Range, or empty: all. The exchange lives until on_end() or stop().
  void start(Exchange& exchange, const std::string& range, std::string_view if_range);
  // Without on_end(). Not from within a call of an exchange.
  void stop(Exchange& exchange);
  void resume(Exchange& exchange);
  // What can be done now, after waiting until something can, for `timeout` at most.
  void run(std::chrono::milliseconds timeout);
  // run() returns. From any thread.
  void wake();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace crease::http

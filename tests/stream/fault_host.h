// A host that answers as a test says: wrong, late, half, or not at all.
//
//   FaultHost host([&](const HostRequest& request) { return good_reply(request, file); });
//   open_http_source(host.url());
//   host.requests();   // that came
#pragma once

#include "crease/byte_source.h"

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace crease {

struct HostRequest {
  int number = 0;  // from 0
  std::string head;

  std::string field(const std::string& name) const;  // empty: it has none
  std::optional<FileRange> range() const;            // of "Range: bytes=a-b"
};

struct HostReply {
  std::string bytes;                               // status line, fields and body
  enum { KeepOpen, Close, Hang } then = KeepOpen;  // Hang: say nothing until the other end goes
};

class FaultHost {
 public:
  using Answer = std::function<HostReply(const HostRequest&)>;  // from threads, one a connection

  explicit FaultHost(Answer answer);
  ~FaultHost();

  std::string url() const;
  std::vector<HostRequest> requests() const;
  void wait_for_requests(std::size_t count) const;
  // Every connection breaks, and nobody listens for a while; then somebody does at the same port.
  void shut();
  void open_again();

 private:
  void listen();
  void accept_all();
  void talk(int connection);

  const Answer answer_;
  int port_ = 0;
  int listener_ = -1;
  mutable std::mutex lock_;
  mutable std::condition_variable changed_;
  std::vector<HostRequest> requests_;
  std::vector<int> connections_;
  std::vector<std::thread> talks_;
  std::thread accepts_;
};

std::string text_of(std::span<const std::byte> bytes);

// A whole answer with the fields that go with its body.
HostReply reply(const std::string& status, const std::string& fields, const std::string& body);
// 206 of what was asked for, 416 of what is beyond the end, 200 without a range, as a sound host
// does it.
HostReply good_reply(const HostRequest& request, std::span<const std::byte> file,
                     const std::string& etag = "\"one\"");

}  // namespace crease

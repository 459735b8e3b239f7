#include "stream/fault_host.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace crease {

namespace {

char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// The bytes up to the empty line, or fewer if the other end goes.
std::string read_head(int connection) {
  std::string head;
  char c = 0;
  while (!head.ends_with("\r\n\r\n") && ::recv(connection, &c, 1, 0) == 1) head += c;
  return head;
}

bool send_all(int connection, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t got = ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (got <= 0) return false;
    sent += static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

std::string HostRequest::field(const std::string& name) const {
  std::string lowered = head;
  std::ranges::transform(lowered, lowered.begin(), lower_case);
  const std::size_t at = lowered.find("\r\n" + name + ": ");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + name.size() + 4;
  return head.substr(begin, head.find("\r\n", begin) - begin);
}

std::optional<FileRange> HostRequest::range() const {
  const std::string text = field("range");
  if (!text.starts_with("bytes=")) return {};
  const std::size_t dash = text.find('-');
  const std::uint64_t first = std::strtoull(text.c_str() + 6, nullptr, 10);
  const std::uint64_t last = std::strtoull(text.c_str() + dash + 1, nullptr, 10);
  return FileRange{first, last - first + 1};
}

FaultHost::FaultHost(Answer answer) : answer_(std::move(answer)) {
  listen();
}

FaultHost::~FaultHost() {
  shut();
}

std::string FaultHost::url() const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/model.crease";
}

std::vector<HostRequest> FaultHost::requests() const {
  const std::lock_guard guard(lock_);
  return requests_;
}

void FaultHost::wait_for_requests(std::size_t count) const {
  std::unique_lock guard(lock_);
  changed_.wait(guard, [&] { return requests_.size() >= count; });
}

void FaultHost::listen() {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port_));
  socklen_t bytes = sizeof address;
  auto* where = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, where, bytes) != 0 || ::listen(listener_, 64) != 0) std::abort();
  ::getsockname(listener_, where, &bytes);
  port_ = ntohs(address.sin_port);
  accepts_ = std::thread([this] { accept_all(); });
}

void FaultHost::accept_all() {
  for (;;) {
    const int connection = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) return;
    const std::lock_guard guard(lock_);
    connections_.push_back(connection);
    talks_.emplace_back([this, connection] { talk(connection); });
  }
}

void FaultHost::talk(int connection) {
  for (;;) {
    HostRequest request;
    request.head = read_head(connection);
    if (!request.head.ends_with("\r\n\r\n")) break;
    {
      const std::lock_guard guard(lock_);
      request.number = static_cast<int>(requests_.size());
      requests_.push_back(request);
    }
    changed_.notify_all();
    const HostReply reply = answer_(request);
    if (!send_all(connection, reply.bytes) || reply.then == HostReply::Close) break;
    if (reply.then == HostReply::Hang) read_head(connection);
  }
  ::shutdown(connection, SHUT_RDWR);
}

void FaultHost::shut() {
  ::shutdown(listener_, SHUT_RDWR);
  if (accepts_.joinable()) accepts_.join();
  ::close(listener_);
  for (const int connection : connections_) ::shutdown(connection, SHUT_RDWR);
  for (std::thread& talk : talks_) talk.join();
  for (const int connection : connections_) ::close(connection);
  talks_.clear();
  connections_.clear();
  listener_ = -1;
}

void FaultHost::open_again() {
  listen();
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

HostReply reply(const std::string& status, const std::string& fields, const std::string& body) {
  return {"HTTP/1.1 " + status + "\r\n" + fields +
              "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body,
          HostReply::KeepOpen};
}

HostReply good_reply(const HostRequest& request, std::span<const std::byte> file,
                     const std::string& etag) {
  const std::string fields = "ETag: " + etag + "\r\n";
  const std::optional<FileRange> range = request.range();
  if (!range) return reply("200 OK", fields, text_of(file));
  if (range->offset >= file.size()) {
    return reply("416 Range Not Satisfiable",
                 fields + "Content-Range: bytes */" + std::to_string(file.size()) + "\r\n", "");
  }
  const std::uint64_t bytes = std::min<std::uint64_t>(range->bytes, file.size() - range->offset);
  return reply("206 Partial Content",
               fields + "Content-Range: bytes " + std::to_string(range->offset) + "-" +
                   std::to_string(range->offset + bytes - 1) + "/" + std::to_string(file.size()) +
                   "\r\n",
               text_of(file.subspan(range->offset, bytes)));
}

}  // namespace crease

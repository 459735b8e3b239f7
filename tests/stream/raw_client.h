// Says to a host exactly what a test wants said, over one connection.
//
//   RawClient client(server->port());
//   const RawAnswer answer = client.ask("GET /../secret HTTP/1.1\r\nHost: x\r\n\r\n");
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace crease {

struct RawAnswer {
  int status = 0;  // 0: none
  std::string head, body;

  // Empty: it has none.
  std::string field(const std::string& name) const {
    const std::size_t at = head.find("\r\n" + name + ": ");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 4;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

class RawClient {
 public:
  explicit RawClient(std::uint16_t port)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      std::abort();
  }
  ~RawClient() { ::close(socket_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  // The body is as long as Content-Length says, but for HEAD, 204 and 304.
  RawAnswer ask(std::string_view request) {
    ::send(socket_, request.data(), request.size(), MSG_NOSIGNAL);
    RawAnswer answer;
    char c = 0;
    while (!answer.head.ends_with("\r\n\r\n") && ::recv(socket_, &c, 1, 0) == 1) answer.head += c;
    if (answer.head.size() > 12) answer.status = std::atoi(answer.head.c_str() + 9);
    if (request.starts_with("HEAD ") || answer.status == 304 || answer.status == 204) return answer;
    std::size_t left = std::strtoull(answer.field("Content-Length").c_str(), nullptr, 10);
    char block[4096];
    while (left > 0) {
      const ssize_t got = ::recv(socket_, block, std::min(left, sizeof block), 0);
      if (got <= 0) break;
      answer.body.append(block, static_cast<std::size_t>(got));
      left -= static_cast<std::size_t>(got);
    }
    return answer;
  }

  RawAnswer get(const std::string& path, const std::string& fields = {},
                const std::string& method = "GET") {
    return ask(method + " " + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n");
  }

 private:
  int socket_;
};

}  // namespace crease

// nginx with the configuration of docs/hosting.md, on loopback: ports, certificate and root are put
// in, nothing else is changed.
#pragma once

#include "stream/stream_files.h"

#include <string>
#include <vector>

#include <sys/types.h>

namespace crease {

class NginxHost {
 public:
  NginxHost();
  ~NginxHost();
  NginxHost(const NginxHost&) = delete;
  NginxHost& operator=(const NginxHost&) = delete;

  const TestFolder& root() const { return root_; }
  std::string url(const std::string& name) const;
  std::string tls_url(const std::string& name) const;
  std::uint16_t port() const { return port_; }
  std::string ca_file() const { return (work_.path() / "cert.pem").string(); }
  // "HTTP/1.1 206 bytes=0-9", of requests that were answered.
  std::vector<std::string> log() const;

 private:
  std::string configuration() const;
  bool start();

  TestFolder root_, work_;
  std::uint16_t port_ = 0, tls_port_ = 0;
  pid_t process_ = -1;
};

}  // namespace crease

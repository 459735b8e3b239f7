#include "stream/nginx_host.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <chrono>
#include <iterator>
#include <thread>

extern char** environ;

namespace crease {

namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

// Nobody listens there now.
std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t bytes = sizeof address;
  ::bind(socket, reinterpret_cast<sockaddr*>(&address), bytes);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &bytes);
  ::close(socket);
  return ntohs(address.sin_port);
}

bool is_listening(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  const int connected =
      ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::close(socket);
  return connected == 0;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

pid_t run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = -1;
  const int failed =
      ::posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return failed == 0 ? process : -1;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, "docs/hosting.md has no: " << from);
  text.replace(at, from.size(), to);
}

}  // namespace

NginxHost::NginxHost() {
  const std::string cert = ca_file(), key = (work_.path() / "key.pem").string();
  const pid_t openssl =
      run({CREASE_OPENSSL, "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256",
           "-nodes", "-days", "2", "-subj", "/CN=crease test", "-addext",
           "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", cert});
  int status = -1;
  ::waitpid(openssl, &status, 0);
  REQUIRE(status == 0);
  bool is_up = false;
  for (int i = 0; i < 5 && !is_up; ++i) is_up = start();  // a port may have been taken meanwhile
  REQUIRE(is_up);
}

NginxHost::~NginxHost() {
  if (process_ <= 0) return;
  ::kill(process_, SIGTERM);
  ::waitpid(process_, nullptr, 0);
}

bool NginxHost::start() {
  port_ = free_port();
  tls_port_ = free_port();
  const std::filesystem::path path = work_.write("nginx.conf", configuration());
  process_ = run({CREASE_NGINX, "-p", work_.path().string(), "-c", path.string(), "-e", "stderr"});
  REQUIRE(process_ > 0);
  while (::waitpid(process_, nullptr, WNOHANG) == 0) {
    if (is_listening(port_) && is_listening(tls_port_)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  process_ = -1;
  return false;
}

std::string NginxHost::configuration() const {
  const std::string page = content_of(CREASE_HOSTING_MD), fence = "```nginx\n";
  const std::size_t begin = page.find(fence) + fence.size();
  std::string server = page.substr(begin, page.find("```", begin) - begin);
  const std::string work = work_.path().string();
  replace(server, "listen 80;", "listen 127.0.0.1:" + std::to_string(port_) + ";");
  replace(server, "listen 443 ssl", "listen 127.0.0.1:" + std::to_string(tls_port_) + " ssl");
  replace(server, "/etc/ssl/certs/models.example.org.pem", ca_file());
  replace(server, "/etc/ssl/private/models.example.org.key", work + "/key.pem");
  replace(server, "/srv/models", root_.path().string());
  // As careless as a configuration may be around it: all is compressed that is not exempt.
  std::string main =
      "daemon off;\nmaster_process off;\npid " + work + "/pid;\nevents { }\nhttp {\n";
  for (const char* kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"}) {
    main += std::string(kind) + "_temp_path " + work + "/" + kind + ";\n";
  }
  return main + "log_format short '$server_protocol $status $http_range';\naccess_log " + work +
         "/log short;\ngzip on;\ngzip_types *;\ngzip_min_length 1;\n" + server + "}\n";
}

std::string NginxHost::url(const std::string& name) const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/" + name;
}

std::string NginxHost::tls_url(const std::string& name) const {
  return "https://127.0.0.1:" + std::to_string(tls_port_) + "/" + name;
}

std::vector<std::string> NginxHost::log() const {
  std::ifstream in(work_.path() / "log");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("HTTP")) lines.push_back(line);  // others looked whether it is up
  }
  return lines;
}

}  // namespace crease

// Serves the files of a folder over HTTP, for demonstrations, viewers and tests: what a static host
// does with a .crease, on this machine.
//
//   Result<std::unique_ptr<FileServer>> server = FileServer::start("models", {.port = 8080});
//   if (!server.ok()) return report(server.failure());
//   open_browser((*server)->url());                  // until *server is gone
//
// GET, HEAD and OPTIONS over HTTP/1.1 with connections that stay open; one range a request (of
// several the file is sent whole, as RFC 9110 14.2 allows), ETag, If-Range, If-None-Match, CORS for
// anybody. A folder is its index.html, else a list of its folders and .crease files; "?json" is
// that list as JSON. Nothing outside of the folder is served, nothing whose name or folder begins
// with a dot, and no symbolic link unless asked for. Files are sent from the disk as they are,
// whatever their size.
//
// Needs crease::crease. No TLS: bind it to loopback, or to a network that may read the folder.
#pragma once

#include "crease/result.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace crease {

// One that was answered.
struct ServedRequest {
  std::string method, path, range;  // as they were sent; range may be empty
  int status = 0;
  std::uint64_t bytes = 0;  // of the body, if all of it goes out
};

struct FileServerOptions {
  std::string host = "127.0.0.1";  // a name or an address of this machine
  std::uint16_t port = 0;          // 0: any that is free
  bool follow_symlinks = false;    // wherever they lead
  // To see what a line does: bytes a second of all answers together (0: as fast as can be), and a
  // pause before each answer.
  double bytes_per_second = 0;
  std::chrono::milliseconds delay{0};
  // Called when an answer begins, from threads of the server, several at a time.
  std::function<void(const ServedRequest&)> on_request{};
};

class FileServer {
 public:
  // Listens when it returns. Fails when there is no such folder or the port is taken.
  static Result<std::unique_ptr<FileServer>> start(const std::filesystem::path& folder,
                                                   const FileServerOptions& options = {});
  // Cuts answers that are under way.
  ~FileServer();
  FileServer(const FileServer&) = delete;
  FileServer& operator=(const FileServer&) = delete;

  std::uint16_t port() const;
  const std::string& url() const;  // http://127.0.0.1:8080/

 private:
  struct State;
  explicit FileServer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace crease

#include "crease/file_server.h"

#include "serve/file_answer.h"
#include "serve/folder_list.h"
#include "serve/open_below.h"
#include "serve/slow_line.h"

#include <fcntl.h>
#include <microhttpd.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

namespace crease {

namespace serve {

namespace {

constexpr unsigned kMaxConnections = 256, kIdleSeconds = 60;
constexpr std::size_t kBlockBytes = 16 * 1024;

struct TypeRow {
  std::string_view extension, type;
};
constexpr TypeRow kTypes[] = {
    {".crease", "application/octet-stream"},
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".txt", "text/plain; charset=utf-8"},
    {".json", "application/json"},
    {".wasm", "application/wasm"},
    {".glb", "model/gltf-binary"},
    {".gltf", "model/gltf+json"},
    {".obj", "model/obj"},
    {".stl", "model/stl"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".jpeg", "image/jpeg"},
    {".svg", "image/svg+xml"},
};

std::string_view type_of(std::string_view name) {
  for (const TypeRow& row : kTypes) {
    if (name.ends_with(row.extension)) return row.type;
  }
  return "application/octet-stream";
}

FileFacts facts_of(const struct stat& told) {
  FileFacts facts;
  facts.bytes = static_cast<std::uint64_t>(told.st_size);
  char etag[96];
  std::snprintf(etag, sizeof etag, "\"%llx-%llx-%llx.%lx\"",
                static_cast<unsigned long long>(told.st_size),
                static_cast<unsigned long long>(told.st_ino),
                static_cast<unsigned long long>(told.st_mtim.tv_sec),
                static_cast<unsigned long>(told.st_mtim.tv_nsec));
  facts.etag = etag;
  facts.last_modified = http_date(told.st_mtime);
  return facts;
}

struct ResponseCleanup {
  void operator()(MHD_Response* response) const { MHD_destroy_response(response); }
};
using Response = std::unique_ptr<MHD_Response, ResponseCleanup>;

Response text_response(std::string_view text) {
  return Response(MHD_create_response_from_buffer(text.size(), const_cast<char*>(text.data()),
                                                  MHD_RESPMEM_MUST_COPY));
}

void add(const Response& response, const char* field, std::string_view value) {
  MHD_add_response_header(response.get(), field, std::string(value).c_str());
}

std::string_view field_of(MHD_Connection* connection, const char* name) {
  const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value != nullptr ? std::string_view(value) : std::string_view{};
}

bool has_argument(MHD_Connection* connection, std::string_view name) {
  const char* value = nullptr;
  std::size_t length = 0;
  return MHD_lookup_connection_value_n(connection, MHD_GET_ARGUMENT_KIND, name.data(), name.size(),
                                       &value, &length) == MHD_YES;
}

// A part of a file that goes out over a slow line.
struct SlowPart {
  OpenFile file;
  std::uint64_t offset = 0;
  SlowLine* line = nullptr;

  static ssize_t read(void* part, std::uint64_t position, char* into, std::size_t room) {
    SlowPart& self = *static_cast<SlowPart*>(part);
    const ssize_t got = ::pread(self.file.get(), into, std::min(room, kBlockBytes),
                                static_cast<off_t>(self.offset + position));
    // A file that became shorter cannot give what was promised.
    if (got <= 0) return MHD_CONTENT_READER_END_WITH_ERROR;
    if (!self.line->pass(static_cast<std::size_t>(got))) return MHD_CONTENT_READER_END_WITH_ERROR;
    return got;
  }
  static void free(void* part) { delete static_cast<SlowPart*>(part); }
};

}  // namespace

}  // namespace serve

using serve::FileAnswer;
using serve::FileFacts;
using serve::Opened;
using serve::Response;
using serve::UrlPath;

struct FileServer::State {
  explicit State(const FileServerOptions& asked) : options(asked), line(asked.bytes_per_second) {}

  FileServerOptions options;
  serve::OpenFile folder;
  serve::SlowLine line;
  MHD_Daemon* daemon = nullptr;
  std::uint16_t port = 0;
  std::string url;

  // One request, from its line to the queued response.
  struct Asked {
    MHD_Connection* connection;
    std::string_view path, method;
  };

  MHD_Result answer(const Asked& asked) {
    if (options.delay.count() > 0 && !line.pause(options.delay)) return MHD_NO;
    if (asked.method == "OPTIONS") return answer_options(asked);
    if (asked.method != "GET" && asked.method != "HEAD") {
      Response response = serve::text_response("only GET, HEAD and OPTIONS\n");
      serve::add(response, "Allow", "GET, HEAD, OPTIONS");
      return queue(asked, MHD_HTTP_METHOD_NOT_ALLOWED, response, 0);
    }
    const std::optional<UrlPath> path = serve::parse_url_path(asked.path);
    std::optional<Opened> opened;
    if (path) opened = serve::open_below(folder.get(), path->names, options.follow_symlinks);
    if (!opened) return answer_not_found(asked);
    if (opened->is_folder()) return answer_folder(asked, *path, *opened);
    if (path->ends_with_slash) return answer_not_found(asked);
    return answer_file(asked, path->names.back(), *std::move(opened));
  }

  MHD_Result answer_not_found(const Asked& asked) {
    constexpr std::string_view kText = "there is no such file\n";
    return queue(asked, MHD_HTTP_NOT_FOUND, serve::text_response(kText), kText.size());
  }

  MHD_Result answer_options(const Asked& asked) {
    Response response = serve::text_response({});
    serve::add(response, "Allow", "GET, HEAD, OPTIONS");
    serve::add(response, "Access-Control-Allow-Methods", "GET, HEAD, OPTIONS");
    serve::add(response, "Access-Control-Allow-Headers",
               "Range, If-Range, If-None-Match, If-Modified-Since");
    serve::add(response, "Access-Control-Max-Age", "86400");
    return queue(asked, MHD_HTTP_NO_CONTENT, response, 0);
  }

  MHD_Result answer_folder(const Asked& asked, const UrlPath& path, const Opened& opened) {
    if (!path.ends_with_slash) {
      Response response = serve::text_response({});
      const bool wants_json = serve::has_argument(asked.connection, "json");
      serve::add(response, "Location", std::string(asked.path) + (wants_json ? "/?json" : "/"));
      return queue(asked, MHD_HTTP_MOVED_PERMANENTLY, response, 0);
    }
    const bool wants_json = serve::has_argument(asked.connection, "json");
    if (!wants_json) {
      std::optional<Opened> index =
          serve::open_below(opened.file.get(), {"index.html"}, options.follow_symlinks);
      if (index && !index->is_folder()) {
        return answer_file(asked, "index.html", *std::move(index));
      }
    }
    std::string shown = "/";
    for (const std::string& name : path.names) shown += name + "/";
    const auto files = serve::list_folder(opened.file.get(), options.follow_symlinks);
    const std::string text =
        wants_json ? serve::list_as_json(shown, files) : serve::list_as_html(shown, files);
    Response response = serve::text_response(text);
    serve::add(response, "Content-Type",
               wants_json ? "application/json" : "text/html; charset=utf-8");
    return queue(asked, MHD_HTTP_OK, response, text.size());
  }

  MHD_Result answer_file(const Asked& asked, std::string_view name, Opened opened) {
    const FileFacts facts = serve::facts_of(opened.facts);
    const FileAnswer answer =
        serve::answer_for(facts, {serve::field_of(asked.connection, "Range"),
                                  serve::field_of(asked.connection, "If-Range"),
                                  serve::field_of(asked.connection, "If-None-Match"),
                                  serve::field_of(asked.connection, "If-Modified-Since")});
    Response response = file_response(std::move(opened.file), answer);
    if (!response) return MHD_NO;
    serve::add(response, "ETag", facts.etag);
    serve::add(response, "Last-Modified", facts.last_modified);
    serve::add(response, "Accept-Ranges", "bytes");
    // Kept as long as it stays the same, which is asked each time.
    serve::add(response, "Cache-Control", "no-cache");
    if (answer.status != 304) serve::add(response, "Content-Type", serve::type_of(name));
    if (!answer.content_range.empty()) {
      serve::add(response, "Content-Range", answer.content_range);
    }
    return queue(asked, answer.status, response, answer.bytes);
  }

  Response file_response(serve::OpenFile file, const FileAnswer& answer) {
    if (answer.bytes == 0) return serve::text_response({});
    if (options.bytes_per_second <= 0) {
      Response response(
          MHD_create_response_from_fd_at_offset64(answer.bytes, file.get(), answer.offset));
      if (response) file.release();  // closed with the response
      return response;
    }
    auto part = std::make_unique<serve::SlowPart>();
    part->file = std::move(file);
    part->offset = answer.offset;
    part->line = &line;
    Response response(MHD_create_response_from_callback(answer.bytes, serve::kBlockBytes,
                                                        &serve::SlowPart::read, part.get(),
                                                        &serve::SlowPart::free));
    if (response) static_cast<void>(part.release());  // freed with the response
    return response;
  }

  MHD_Result queue(const Asked& asked, int status, const Response& response, std::uint64_t bytes) {
    serve::add(response, "Access-Control-Allow-Origin", "*");
    serve::add(response, "Access-Control-Expose-Headers",
               "Accept-Ranges, Content-Length, Content-Range, ETag, Last-Modified");
    serve::add(response, "Cross-Origin-Resource-Policy", "cross-origin");
    serve::add(response, "X-Content-Type-Options", "nosniff");
    if (options.on_request) {
      options.on_request({std::string(asked.method), std::string(asked.path),
                          std::string(serve::field_of(asked.connection, "Range")), status,
                          asked.method == "HEAD" ? 0 : bytes});
    }
    return MHD_queue_response(asked.connection, static_cast<unsigned>(status), response.get());
  }

  static MHD_Result on_request(void* state, MHD_Connection* connection, const char* path,
                               const char* method, const char*, const char*,
                               std::size_t* upload_bytes, void** per_request) {
    static int seen;
    if (*per_request == nullptr) {  // the header is there; a body, which nobody wants, may follow
      *per_request = &seen;
      return MHD_YES;
    }
    if (*upload_bytes > 0) {
      *upload_bytes = 0;
      return MHD_YES;
    }
    return static_cast<State*>(state)->answer({connection, path, method});
  }

  // Paths are decoded in one place, open_below.cpp.
  static std::size_t leave_encoded(void*, MHD_Connection*, char* text) { return std::strlen(text); }

  Status listen() {
    struct AddressCleanup {
      void operator()(addrinfo* list) const { freeaddrinfo(list); }
    };
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    addrinfo* list = nullptr;
    const int found =
        getaddrinfo(options.host.c_str(), std::to_string(options.port).c_str(), &hints, &list);
    if (found != 0) {
      return fail(Error::CommandLine,
                  options.host + ": no address of this machine: " + gai_strerror(found));
    }
    const std::unique_ptr<addrinfo, AddressCleanup> addresses(list);
    unsigned flags = MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_POLL;
    if (addresses->ai_family == AF_INET6) flags |= MHD_USE_IPv6;
    errno = 0;
    daemon = MHD_start_daemon(flags, 0, nullptr, nullptr, &State::on_request, this,
                              MHD_OPTION_SOCK_ADDR, addresses->ai_addr, MHD_OPTION_CONNECTION_LIMIT,
                              serve::kMaxConnections, MHD_OPTION_CONNECTION_TIMEOUT,
                              serve::kIdleSeconds, MHD_OPTION_UNESCAPE_CALLBACK,
                              &State::leave_encoded, nullptr, MHD_OPTION_END);
    if (daemon == nullptr) {
      return fail(Error::ReadFailed, options.host + " port " + std::to_string(options.port) +
                                         ": cannot be listened at: " + std::strerror(errno));
    }
    port = MHD_get_daemon_info(daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
    const bool needs_brackets = options.host.find(':') != std::string::npos;
    url = "http://" + (needs_brackets ? "[" + options.host + "]" : options.host) + ":" +
          std::to_string(port) + "/";
    return Done{};
  }
};

Result<std::unique_ptr<FileServer>> FileServer::start(const std::filesystem::path& folder,
                                                      const FileServerOptions& options) {
  auto state = std::make_unique<State>(options);
  state->folder = serve::OpenFile(::open(folder.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY));
  if (!state->folder) {
    const Error error = errno == ENOENT ? Error::NotFound : Error::ReadFailed;
    return fail(error, folder.string() + ": cannot be served: " + std::strerror(errno));
  }
  if (Status status = state->listen(); !status.ok()) return status.failure();
  return std::unique_ptr<FileServer>(new FileServer(std::move(state)));
}

FileServer::FileServer(std::unique_ptr<State> state) : state_(std::move(state)) {}

FileServer::~FileServer() {
  state_->line.cut();
  MHD_stop_daemon(state_->daemon);
}

std::uint16_t FileServer::port() const {
  return state_->port;
}

const std::string& FileServer::url() const {
  return state_->url;
}

}  // namespace crease

#include "http/transport.h"

#include "base/assert.h"
#include "http/url.h"

#include <curl/curl.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace crease::http {

namespace {

struct EasyCleanup {
  void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
};
struct ListCleanup {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

// A request in flight.
struct Request {
  std::unique_ptr<CURL, EasyCleanup> easy;
  std::unique_ptr<curl_slist, ListCleanup> fields;
  Exchange* exchange = nullptr;
  bool was_stopped = false;
  char problem[CURL_ERROR_SIZE] = "";
};

std::size_t on_header(char* line, std::size_t one, std::size_t count, void* request) {
  static_cast<Request*>(request)->exchange->on_header({line, one * count});
  return one * count;
}

std::size_t on_body(char* chunk, std::size_t one, std::size_t count, void* user) {
  Request& request = *static_cast<Request*>(user);
  const std::size_t bytes = one * count;
  const auto flow = request.exchange->on_body(std::as_bytes(std::span<const char>(chunk, bytes)));
  if (flow == Exchange::Flow::Pause) return CURL_WRITEFUNC_PAUSE;
  request.was_stopped = flow == Exchange::Flow::Stop;
  return request.was_stopped ? CURL_WRITEFUNC_ERROR : bytes;
}

// What is wrong with the question rather than with the way to the host.
bool is_final(CURLcode code) {
  switch (code) {
    case CURLE_URL_MALFORMAT:
    case CURLE_UNSUPPORTED_PROTOCOL:
    case CURLE_TOO_MANY_REDIRECTS:
    case CURLE_PEER_FAILED_VERIFICATION:
    case CURLE_SSL_CACERT_BADFILE:
    case CURLE_SSL_CERTPROBLEM:
    case CURLE_OUT_OF_MEMORY:
      return true;
    default:
      return false;
  }
}

void start_curl() {
  static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT);
  CREASE_ASSERT(started == CURLE_OK);
}

}  // namespace

struct Transport::State {
  std::string url;
  HttpOptions options;
  CURLM* multi = nullptr;
  std::vector<std::unique_ptr<Request>> requests;

  std::unique_ptr<Request> remove(const Exchange& exchange) {
    const auto found = std::ranges::find(requests, &exchange, [](const auto& request) {
      return static_cast<const Exchange*>(request->exchange);
    });
    if (found == requests.end()) return nullptr;
    std::unique_ptr<Request> request = std::move(*found);
    requests.erase(found);
    curl_multi_remove_handle(multi, request->easy.get());
    return request;
  }

  void set_options(Request& request) const {
    CURL* easy = request.easy.get();
    const auto set = [easy](CURLoption option, auto value) {
      const CURLcode done = curl_easy_setopt(easy, option, value);
      CREASE_ASSERT(done == CURLE_OK);
    };
    set(CURLOPT_URL, url.c_str());
    set(CURLOPT_PROTOCOLS_STR, "http,https");
    set(CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
    set(CURLOPT_FOLLOWLOCATION, 1L);
    set(CURLOPT_MAXREDIRS, 5L);
    set(CURLOPT_NOSIGNAL, 1L);
    set(CURLOPT_USERAGENT, "crease");
    // HTTP/2 over TLS where the host can; then the requests share the first one's connection.
    set(CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_2TLS));
    if (url.starts_with("https:")) set(CURLOPT_PIPEWAIT, 1L);
    set(CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(options.connect_timeout.count()));
    set(CURLOPT_LOW_SPEED_LIMIT, static_cast<long>(options.low_speed_bytes));
    set(CURLOPT_LOW_SPEED_TIME, static_cast<long>(options.low_speed_seconds));
    if (!options.ca_file.empty()) set(CURLOPT_CAINFO, options.ca_file.c_str());
    set(CURLOPT_ERRORBUFFER, static_cast<char*>(request.problem));
    set(CURLOPT_SUPPRESS_CONNECT_HEADERS, 1L);  // a proxy's are no answer of the host
    set(CURLOPT_HEADERFUNCTION, &on_header);
    set(CURLOPT_HEADERDATA, static_cast<void*>(&request));
    set(CURLOPT_WRITEFUNCTION, &on_body);
    set(CURLOPT_WRITEDATA, static_cast<void*>(&request));
    set(CURLOPT_PRIVATE, static_cast<void*>(&request));
  }

  void end(CURL* easy, CURLcode code) {
    Request* ended = nullptr;
    curl_easy_getinfo(easy, CURLINFO_PRIVATE, &ended);
    const std::unique_ptr<Request> request = remove(*ended->exchange);
    if (code == CURLE_OK || request->was_stopped) return request->exchange->on_end({}, true);
    std::string problem = request->problem[0] != 0 ? request->problem : curl_easy_strerror(code);
    request->exchange->on_end(problem, !is_final(code));
  }
};

Transport::Transport(std::string url, const HttpOptions& options)
    : state_(std::make_unique<State>()) {
  start_curl();
  state_->url = url_to_ask(url);
  state_->options = options;
  state_->multi = curl_multi_init();
  CREASE_ASSERT(state_->multi != nullptr);
  curl_multi_setopt(state_->multi, CURLMOPT_MAX_HOST_CONNECTIONS,
                    static_cast<long>(options.async.max_in_flight));
}

Transport::~Transport() {
  while (!state_->requests.empty()) state_->remove(*state_->requests.back()->exchange);
  curl_multi_cleanup(state_->multi);
}

void Transport::start(Exchange& exchange, const std::string& range, std::string_view if_range) {
  auto request = std::make_unique<Request>();
  request->easy.reset(curl_easy_init());
  request->exchange = &exchange;
  CREASE_ASSERT(request->easy != nullptr);
  state_->set_options(*request);
  if (!range.empty()) {
    curl_easy_setopt(request->easy.get(), CURLOPT_RANGE, range.c_str());
    if (!if_range.empty()) {
      const std::string field = "If-Range: " + std::string(if_range);
      request->fields.reset(curl_slist_append(nullptr, field.c_str()));
      curl_easy_setopt(request->easy.get(), CURLOPT_HTTPHEADER, request->fields.get());
    }
  }
  curl_multi_add_handle(state_->multi, request->easy.get());
  state_->requests.push_back(std::move(request));
}

void Transport::stop(Exchange& exchange) {
  state_->remove(exchange);
}

void Transport::resume(Exchange& exchange) {
  for (const auto& request : state_->requests) {
    if (request->exchange != &exchange) continue;
    curl_easy_pause(request->easy.get(), CURLPAUSE_CONT);
    return;
  }
}

void Transport::run(std::chrono::milliseconds timeout) {
  int running = 0;
  curl_multi_perform(state_->multi, &running);
  int left = 0;
  bool has_ended = false;
  while (const CURLMsg* message = curl_multi_info_read(state_->multi, &left)) {
    if (message->msg != CURLMSG_DONE) continue;
    // The message is gone once its handle is.
    state_->end(message->easy_handle, message->data.result);
    has_ended = true;
  }
  if (has_ended) return;  // the next requests need not wait
  curl_multi_poll(state_->multi, nullptr, 0, static_cast<int>(timeout.count()), nullptr);
}

void Transport::wake() {
  curl_multi_wakeup(state_->multi);
}

}  // namespace crease::http

// The asynchronous source of a URL: one thread that asks the host for what is on the board.
//
// At first the *opening* request brings the first 64 KiB, the size and the identity. From then on
// batches are requests of their own (*part*), each with If-Range, each begun anew from where it
// broke. Where the host answers the opening with all of the file, that one request goes on
// (*whole*): it fills the prefix of the board as long as somebody waits for bytes beyond it.
//
// Everything private but board_ and is_ending_ belongs to the thread.
#pragma once

#include "http/response_reader.h"
#include "http/transport.h"
#include "stream/request_board.h"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace crease::http {

class Loader final : public stream::BoardSource {
 public:
  Loader(const std::string& url, const HttpOptions& options);
  ~Loader() override;

 private:
  class Transfer;
  enum class Role { Opening, Part, Whole };

  void run();
  void drop_what_nobody_wants();
  void start_what_can_start();
  std::chrono::milliseconds pause() const;
  void begin(Role role, std::optional<stream::Batch> batch);
  bool has(Role role) const;
  // The first answer says which file it is.
  void get_to_know(const Identity& identity);

  const HttpOptions options_;
  Transport transport_;
  std::vector<std::unique_ptr<Transfer>> transfers_;
  std::optional<Identity> known_;
  bool is_whole_ = false;          // the host ignores ranges
  std::optional<Failure> broken_;  // for good: the file was replaced
  // Of an opening that failed before anybody asked: who asks first hears of it.
  std::optional<Failure> unheard_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace crease::http

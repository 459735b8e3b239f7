#include "http/loader.h"

#include "http/url.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace crease::http {

namespace {

using stream::Batch;
using stream::Clock;

constexpr std::uint64_t kFirstBytes = 64 * 1024;
constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max();
// To wait for so many bytes that nobody wants is cheaper than another connection.
constexpr std::uint64_t kCheapBytes = 64 * 1024;

}  // namespace

// One request and its further attempts.
class Loader::Transfer final : public Exchange {
 public:
  Transfer(Loader& loader, Role role, std::optional<Batch> batch)
      : loader_(loader), role_(role), batch_(std::move(batch)) {}

  Role role() const { return role_; }
  bool is_done() const { return is_done_; }
  bool is_paused() const { return is_paused_; }
  bool is_started() const { return is_started_; }
  Clock::time_point not_before() const { return not_before_; }

  void start() {
    const FileRange rest = missing();
    reader_.emplace(rest, loader_.known_ ? &*loader_.known_ : nullptr);
    std::string range;
    const std::uint64_t end = role_ == Role::Part ? rest.offset + rest.bytes : kFirstBytes;
    if (role_ != Role::Whole) {
      range = std::to_string(rest.offset) + "-" + std::to_string(end - 1);
    }
    if (attempts_++ == 0) {
      loader_.board_.count_request();
    } else {
      loader_.board_.count_retry();
    }
    is_started_ = true;
    is_paused_ = false;
    has_progress_ = false;
    loader_.transport_.start(*this, range,
                             loader_.known_ ? loader_.known_->validator() : std::string_view{});
  }

  void stop() {
    if (is_started_) loader_.transport_.stop(*this);
    is_done_ = true;
  }

  void resume() {
    is_paused_ = false;
    loader_.transport_.resume(*this);
  }

  // Nobody wants its bytes, and there are many of them.
  bool is_in_vain() const {
    return role_ == Role::Part && loader_.board_.is_abandoned(*batch_) &&
           (!is_started_ || missing().bytes > kCheapBytes);
  }

 private:
  FileRange missing() const {
    if (role_ != Role::Part) return {loader_.board_.prefix_bytes(), kEndless};
    return {batch_->span.offset + bytes_.size(), batch_->span.bytes - bytes_.size()};
  }

  void on_header(std::string_view line) override { reader_->on_header(line); }

  Flow on_body(std::span<const std::byte> chunk) override {
    if (!reader_->is_answer()) return is_dispensable(chunk.size()) ? Flow::Stop : Flow::Go;
    learn();
    stream::RequestBoard& board = loader_.board_;
    if (role_ == Role::Whole && loader_.known_->size && !board.has_waiting() &&
        board.prefix_bytes() >= kFirstBytes) {
      is_paused_ = true;
      return Flow::Pause;
    }
    board.count_transferred(chunk.size());
    const std::span<const std::byte> wanted = reader_->on_body(chunk);
    has_progress_ = has_progress_ || !wanted.empty();
    if (role_ == Role::Part) {
      bytes_.insert(bytes_.end(), wanted.begin(), wanted.end());
      board.deliver(*batch_, bytes_);
    } else if (board.prefix_bytes() + wanted.size() > loader_.options_.max_whole_bytes) {
      is_too_large_ = true;
      return Flow::Stop;
    } else {
      board.append_prefix(wanted, expected_prefix());
      if (role_ == Role::Opening && board.prefix_bytes() > kFirstBytes) return Flow::Stop;
    }
    // What ends by itself leaves its connection to the next request.
    return wanted.size() < chunk.size() && !reader_->wants_more() ? Flow::Stop : Flow::Go;
  }

  // What the host promises may be anything.
  std::uint64_t expected_prefix() const {
    if (role_ != Role::Whole) return kFirstBytes;
    return std::min(loader_.known_->size.value_or(0), loader_.options_.max_whole_bytes);
  }

  // Of the body of a refusal: short ones are read, for the sake of the connection.
  bool is_dispensable(std::size_t bytes) {
    loader_.board_.count_transferred(bytes);
    refusal_bytes_ += bytes;
    return refusal_bytes_ > kCheapBytes;
  }

  void learn() {
    if (!loader_.known_) loader_.get_to_know(reader_->identity());
    if (role_ != Role::Opening || !reader_->is_whole_file()) return;
    role_ = Role::Whole;
    loader_.is_whole_ = true;
  }

  void on_end(const std::string& problem, bool may_pass) override {
    is_started_ = false;
    if (reader_->is_answer()) learn();
    if (is_too_large_) {
      return give_up(fail(Error::OverLimit,
                          "the host ignores byte ranges, and all of the file is more than the "
                          "limit of " +
                              std::to_string(loader_.options_.max_whole_bytes) +
                              " bytes; use a host with byte ranges"));
    }
    if (role_ == Role::Opening && loader_.known_ && loader_.board_.prefix_bytes() >= kFirstBytes) {
      is_done_ = true;  // perhaps of more than was asked for
      return;
    }
    Verdict verdict = reader_->finish(!problem.empty());
    using Kind = Verdict::Kind;
    if (verdict.kind == Kind::Again && !problem.empty()) verdict.failure.message = problem;
    if (verdict.kind == Kind::Again && !may_pass) verdict.kind = Kind::Refused;
    if (verdict.kind == Kind::Refused) return give_up(verdict.failure);
    if (verdict.kind == Kind::Again) return try_later(verdict);
    if (role_ == Role::Part && verdict.kind == Kind::Partial) {
      failures_ = 0;
      not_before_ = Clock::now();
      return;
    }
    if (role_ == Role::Whole && !loader_.known_->size) {
      loader_.known_->size = loader_.board_.prefix_bytes();
      loader_.board_.set_size(*loader_.known_->size);
    }
    is_done_ = true;
  }

  void try_later(const Verdict& verdict) {
    if (has_progress_) failures_ = 0;
    if (++failures_ > loader_.options_.max_retries) {
      Failure failure = verdict.failure;
      failure.message +=
          " (" + std::to_string(attempts_) + (attempts_ == 1 ? " attempt)" : " attempts)");
      return give_up(failure);
    }
    const HttpOptions& options = loader_.options_;
    std::chrono::milliseconds pause = options.first_pause * (1 << std::min(failures_ - 1, 20));
    if (verdict.retry_after_s) {
      pause =
          std::max<std::chrono::milliseconds>(pause, std::chrono::seconds(*verdict.retry_after_s));
    }
    not_before_ = Clock::now() + std::min(pause, options.max_pause);
  }

  void give_up(const Failure& failure) {
    is_done_ = true;
    if (failure.error == Error::Replaced) loader_.broken_ = failure;
    if (role_ == Role::Part) return loader_.board_.fail(*batch_, failure);
    if (!loader_.board_.fail_waiting(failure)) loader_.unheard_ = failure;
  }

  Loader& loader_;
  Role role_;
  std::optional<Batch> batch_;    // of Role::Part
  std::vector<std::byte> bytes_;  // of its span, from the begin on
  std::optional<ResponseReader> reader_;
  std::uint64_t refusal_bytes_ = 0;
  int attempts_ = 0, failures_ = 0;  // failures: since the last byte that came
  Clock::time_point not_before_{};
  bool is_started_ = false, is_paused_ = false, is_done_ = false;
  bool has_progress_ = false, is_too_large_ = false;
};

Loader::Loader(const std::string& url, const HttpOptions& options)
    : BoardSource(printable_url(url), options.async, [this] { transport_.wake(); }),
      options_(options),
      transport_(url, options) {
  thread_ = std::thread([this] { run(); });
}

Loader::~Loader() {
  is_ending_ = true;
  transport_.wake();
  thread_.join();
}

void Loader::run() {
  begin(Role::Opening, {});
  while (!is_ending_) {
    drop_what_nobody_wants();
    start_what_can_start();
    transport_.run(pause());
    std::erase_if(transfers_, [](const auto& transfer) { return transfer->is_done(); });
  }
  for (const auto& transfer : transfers_) transfer->stop();
}

void Loader::drop_what_nobody_wants() {
  for (const auto& transfer : transfers_) {
    if (transfer->is_in_vain()) transfer->stop();
  }
  std::erase_if(transfers_, [](const auto& transfer) { return transfer->is_done(); });
}

void Loader::start_what_can_start() {
  const Clock::time_point now = Clock::now();
  for (const auto& transfer : transfers_) {
    if (!transfer->is_started() && transfer->not_before() <= now) transfer->start();
    if (transfer->is_paused() && board_.has_waiting()) transfer->resume();
  }
  if (!board_.has_waiting()) return;
  if (broken_) {
    board_.fail_waiting(*broken_);
    return;
  }
  if (unheard_) {
    if (board_.fail_waiting(*unheard_)) unheard_.reset();
    return;
  }
  if (has(Role::Opening) || has(Role::Whole)) return;
  if (!known_ || is_whole_) return begin(known_ ? Role::Whole : Role::Opening, {});
  const auto limit = static_cast<std::size_t>(std::max(1, options_.async.max_in_flight));
  while (transfers_.size() < limit) {
    std::optional<Batch> batch = board_.take();
    if (!batch) return;
    begin(Role::Part, std::move(batch));
  }
}

// How long nothing can be done but waiting for the host.
std::chrono::milliseconds Loader::pause() const {
  std::chrono::milliseconds pause{10'000};
  for (const auto& transfer : transfers_) {
    if (transfer->is_started()) continue;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(transfer->not_before() - Clock::now());
    pause = std::clamp(left, std::chrono::milliseconds(0), pause);
  }
  return pause;
}

void Loader::begin(Role role, std::optional<Batch> batch) {
  transfers_.push_back(std::make_unique<Transfer>(*this, role, std::move(batch)));
  transfers_.back()->start();
}

bool Loader::has(Role role) const {
  return std::ranges::any_of(transfers_,
                             [role](const auto& transfer) { return transfer->role() == role; });
}

void Loader::get_to_know(const Identity& identity) {
  known_ = identity;
  if (identity.size) board_.set_size(*identity.size);
}

}  // namespace crease::http

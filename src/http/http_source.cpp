// The blocking source: an asynchronous one, what it has brought, and threads that wait for it.
#include "crease/http_source.h"

#include "http/loader.h"
#include "http/transferred_bytes.h"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace crease {

namespace {

constexpr std::chrono::milliseconds kGlance{100};  // how often `stopped` is asked

class HttpSource final : public ByteSource {
 public:
  HttpSource(AsyncSourcePtr loader, const HttpOptions& options)
      : loader_(std::move(loader)), stopped_(options.stopped), kept_(options.keep_bytes) {}

  std::string name() const override { return loader_->name(); }
  std::uint64_t size() const override { return loader_->size().value_or(0); }
  std::uint64_t bytes_read() const override { return loader_->statistics().bytes_transferred; }

  // Waits for the first answer.
  Status open() const {
    std::unique_lock guard(lock_);
    const Bytes nothing = wait_for(loader_->request(FileRange{0, 0}), guard);
    if (!nothing.ok()) return nothing.failure();
    return Done{};
  }

  // Half of what is kept may be what nobody has read yet; more would push itself out.
  void prefetch(std::span<const FileRange> ranges) const override {
    const std::lock_guard guard(lock_);
    take_answers();
    std::vector<FileRange> wanted;
    std::vector<RangeRequest> requests;
    std::uint64_t unread = kept_.unread_bytes() + coming_bytes_;
    for (const FileRange& range : ranges) {
      if (kept_.has(range) || coming_.contains(range.offset)) continue;
      unread += range.bytes;
      if (unread > kept_.max_bytes() / 2) break;
      wanted.push_back(range);
      requests.push_back({rest_of(range), 0});
    }
    const Ticket first = loader_->request(requests);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const FileRange& range = wanted[i];
      coming_.emplace(range.offset, Coming{ticket_after(first, i), range.bytes});
      prefetched_.emplace(number(ticket_after(first, i)), range);
      coming_bytes_ += range.bytes;
    }
  }

 private:
  using Bytes = Result<std::vector<std::byte>>;
  struct Coming {
    Ticket ticket{};
    std::uint64_t bytes = 0;
  };

  // Without the bytes at its begin that were transferred already: those of a block that the end of
  // the first request cuts.
  FileRange rest_of(const FileRange& range) const {
    const std::uint64_t begun = kept_.begin_of(range).size();
    return {range.offset + begun, range.bytes - begun};
  }

  // What came for rest_of(range).
  void keep(const FileRange& range, std::vector<std::byte> bytes) const {
    const std::uint64_t begun = range.bytes - bytes.size();
    const std::span<const std::byte> begin = kept_.begin_of({range.offset, begun});
    if (begin.size() == begun) {
      bytes.insert(bytes.begin(), begin.begin(), begin.end());
      kept_.put(range.offset, std::move(bytes));
    } else {  // dropped since
      kept_.put(range.offset + begun, std::move(bytes));
    }
  }

  static std::uint64_t number(Ticket ticket) { return static_cast<std::uint64_t>(ticket); }

  Status read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    std::unique_lock guard(lock_);
    take_answers();
    if (kept_.read(offset, into)) return Done{};
    const auto coming = coming_.find(offset);
    if (coming != coming_.end() && coming->second.bytes >= into.size()) {
      // It keeps its turn: alone and before the others it would take a request of its own.
      const std::uint64_t ticket = number(coming->second.ticket);
      while (prefetched_.contains(ticket)) {
        if (Status status = wait(guard); !status.ok()) return status;
      }
      if (kept_.read(offset, into)) return Done{};  // else it failed, and may not now
    }
    const std::span<const std::byte> begin = kept_.begin_of({offset, into.size()});
    const std::size_t begun = begin.size();
    std::copy(begin.begin(), begin.end(), into.begin());
    Bytes bytes = wait_for(loader_->request({offset + begun, into.size() - begun}, 1), guard);
    if (!bytes.ok()) return without_name(bytes.failure());
    std::copy(bytes->begin(), bytes->end(), into.begin() + static_cast<std::ptrdiff_t>(begun));
    keep({offset, into.size()}, *std::move(bytes));
    kept_.mark_read(offset);
    return Done{};
  }

  // As with other byte sources, whose names the caller adds.
  Failure without_name(Failure failure) const {
    const std::string prefix = name() + ": ";
    if (failure.message.starts_with(prefix)) failure.message.erase(0, prefix.size());
    return failure;
  }

  Bytes wait_for(Ticket ticket, std::unique_lock<std::mutex>& guard) const {
    for (;;) {
      take_answers();
      if (const auto found = arrived_.find(number(ticket)); found != arrived_.end()) {
        Bytes bytes = std::move(found->second);
        arrived_.erase(found);
        return bytes;
      }
      if (Status status = wait(guard); !status.ok()) {
        loader_->cancel(ticket);
        return status.failure();
      }
    }
  }

  // Until something may have arrived. Of several threads one waits for the loader, the others for
  // it.
  Status wait(std::unique_lock<std::mutex>& guard) const {
    if (has_waiter_) {
      something_arrived_.wait_for(guard, kGlance);
    } else {
      has_waiter_ = true;
      guard.unlock();
      loader_->wait(kGlance);
      guard.lock();
      has_waiter_ = false;
      take_answers();
      something_arrived_.notify_all();
    }
    if (stopped_ && stopped_()) return fail(Error::Interrupted, "interrupted");
    return Done{};
  }

  void take_answers() const {
    for (AsyncAnswer& answer : loader_->poll()) {
      const auto found = prefetched_.find(number(answer.ticket));
      if (found == prefetched_.end()) {
        arrived_.emplace(number(answer.ticket), std::move(answer.bytes));
        continue;
      }
      const FileRange range = found->second;
      prefetched_.erase(found);
      coming_.erase(range.offset);
      coming_bytes_ -= range.bytes;
      if (answer.bytes.ok()) keep(range, *std::move(answer.bytes));
    }
  }

  const AsyncSourcePtr loader_;
  const std::function<bool()> stopped_;
  mutable std::mutex lock_;
  mutable std::condition_variable something_arrived_;
  mutable bool has_waiter_ = false;
  mutable http::TransferredBytes kept_;
  mutable std::unordered_map<std::uint64_t, Bytes> arrived_;         // by ticket
  mutable std::unordered_map<std::uint64_t, FileRange> prefetched_;  // that have not arrived
  mutable std::map<std::uint64_t, Coming> coming_;                   // the same, by offset
  mutable std::uint64_t coming_bytes_ = 0;
};

}  // namespace

Result<ByteSourcePtr> open_http_source(const std::string& url, const HttpOptions& options) {
  const auto source = std::make_shared<HttpSource>(open_async_http(url, options), options);
  if (Status status = source->open(); !status.ok()) return status.failure();
  return ByteSourcePtr(source);
}

AsyncSourcePtr open_async_http(const std::string& url, const HttpOptions& options) {
  return std::make_shared<http::Loader>(url, options);
}

}  // namespace crease

// An asynchronous source that answers when and as its owner says: late, in any order, wrongly, with
// bytes of another file, or not at all but with a failure.
//
//   FaultySource source(bytes);
//   source.answer(source.waiting_count() - 1, Fault::Corrupted, 17);   // the last one, byte 17
//   source.answer_all();                                               // rightly
#pragma once

#include "crease/async_source.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace crease {

enum class Fault : std::uint8_t {
  None,
  Failed,     // no bytes but a reason
  Corrupted,  // one bit is another
  Truncated,
  Longer,
  OtherFile,  // bytes from the same place of a file that has replaced it
  Unknown,    // right, but of a ticket that nobody has
};
inline constexpr int kFaultCount = 7;

class FaultySource : public AsyncSource {
 public:
  // Both must outlive it.
  explicit FaultySource(std::span<const std::byte> bytes, std::span<const std::byte> other = {})
      : bytes_(bytes), other_(other) {}

  std::string name() const override { return "faulty"; }
  std::optional<std::uint64_t> size() const override { return bytes_.size(); }

  Ticket request(std::span<const RangeRequest> ranges) override {
    const Ticket first{next_};
    for (const RangeRequest& r : ranges) {
      const Ticket ticket{next_++};
      if (auto back = given_back_.extract(r.range.offset)) {  // once, and as wrong as it was
        answers_.push_back({ticket, std::move(back.mapped())});
      } else {
        waiting_[ticket] = r.range;
      }
    }
    return first;
  }
  void give_back(std::uint64_t offset, std::vector<std::byte> bytes) override {
    given_back_[offset] = std::move(bytes);
  }
  void cancel(Ticket ticket) override { waiting_.erase(ticket); }
  void prioritize(Ticket, float) override {}
  std::vector<AsyncAnswer> poll() override { return std::exchange(answers_, {}); }
  bool wait(std::chrono::milliseconds) override { return !answers_.empty(); }
  AsyncStatistics statistics() const override { return {}; }

  std::size_t waiting_count() const { return waiting_.size(); }
  // Of those that wait, in the order of asking; `detail` says where or how far.
  void answer(std::size_t index, Fault fault, std::size_t detail) {
    const auto at = std::next(waiting_.begin(), std::ptrdiff_t(index));
    const Ticket ticket = fault == Fault::Unknown ? Ticket{~std::uint64_t(0)} : at->first;
    answers_.push_back({ticket, answer_of(at->second, fault, detail)});
    if (fault != Fault::Unknown) waiting_.erase(at);
  }
  void answer_all() {
    while (!waiting_.empty()) answer(0, Fault::None, 0);
  }

 private:
  Result<std::vector<std::byte>> answer_of(const FileRange& range, Fault fault,
                                           std::size_t detail) const {
    if (fault == Fault::Failed) return fail(Error::ReadFailed, "faulty: broke");
    std::vector<std::byte> bytes = part(bytes_, range);
    if (fault == Fault::OtherFile) bytes = part(other_, range);
    if (bytes.empty()) return bytes;
    if (fault == Fault::Corrupted) {
      bytes[detail / 8 % bytes.size()] ^= static_cast<std::byte>(1u << detail % 8);
    }
    if (fault == Fault::Truncated) bytes.resize(detail % bytes.size());
    if (fault == Fault::Longer) bytes.resize(bytes.size() + 1 + detail % 100);
    return bytes;
  }

  static std::vector<std::byte> part(std::span<const std::byte> bytes, const FileRange& range) {
    const std::size_t first = std::min<std::uint64_t>(range.offset, bytes.size());
    const std::size_t count = std::min<std::uint64_t>(range.bytes, bytes.size() - first);
    return {bytes.begin() + std::ptrdiff_t(first), bytes.begin() + std::ptrdiff_t(first + count)};
  }

  const std::span<const std::byte> bytes_, other_;
  std::uint64_t next_ = 1;
  std::map<Ticket, FileRange> waiting_;
  std::map<std::uint64_t, std::vector<std::byte>> given_back_;  // by offset
  std::vector<AsyncAnswer> answers_;
};

}  // namespace crease

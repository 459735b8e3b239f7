#include "crease/async_source.h"

#include "stream/request_board.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace crease {

namespace {

using stream::Batch;
using stream::BatchPart;
using stream::BoardSource;

class AsyncMemory final : public BoardSource {
 public:
  AsyncMemory(std::span<const std::byte> bytes, std::string name)
      : BoardSource(std::move(name), {}) {
    board_.set_prefix(bytes);
    board_.set_size(bytes.size());
  }
};

// Reads by threads of its own, each with one batch at a time.
class AsyncReader final : public BoardSource {
 public:
  AsyncReader(ByteSourcePtr source, const AsyncOptions& options)
      : BoardSource(source->name(), options), source_(std::move(source)) {
    const int count = std::max(1, options.max_in_flight);
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
  }
  ~AsyncReader() override {
    board_.close();
    for (std::thread& thread : threads_) thread.join();
  }

  std::optional<std::uint64_t> size() const override { return source_->size(); }

 private:
  void work() {
    while (std::optional<Batch> batch = board_.take_or_wait()) {
      if (board_.is_abandoned(*batch)) continue;
      board_.count_request();
      Result<std::vector<std::byte>> bytes = read(batch->span);
      if (bytes.ok()) {
        board_.deliver(*batch, *bytes);
      } else if (batch->parts.size() == 1) {
        board_.answer(batch->parts.front(), std::move(bytes));
      } else {
        // What is wrong with one of them is no matter of the others.
        for (const BatchPart& part : batch->parts) board_.answer(part, read(part.range));
      }
    }
  }

  Result<std::vector<std::byte>> read(const FileRange& range) {
    const std::uint64_t there = source_->size();
    if (!stream::lies_within(range, there)) return stream::beyond_end(range, there);
    std::vector<std::byte> bytes(static_cast<std::size_t>(range.bytes));
    if (Status status = source_->read(range.offset, bytes); !status.ok()) return status.failure();
    board_.count_transferred(range.bytes);
    return bytes;
  }

  ByteSourcePtr source_;
  std::vector<std::thread> threads_;
};

}  // namespace

AsyncSourcePtr async_memory_source(std::span<const std::byte> bytes, std::string name) {
  return std::make_shared<AsyncMemory>(bytes, std::move(name));
}

AsyncSourcePtr async_source(ByteSourcePtr source, const AsyncOptions& options) {
  return std::make_shared<AsyncReader>(std::move(source), options);
}

Result<AsyncSourcePtr> open_async_file(const std::filesystem::path& path,
                                       const AsyncOptions& options) {
  Result<ByteSourcePtr> source = open_file_source(path);
  if (!source.ok()) return source.failure();
  return async_source(*std::move(source), options);
}

}  // namespace crease

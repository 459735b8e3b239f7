// Where the bytes of a written file go.
#pragma once

#include "crease/result.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease {

// Positioned, as a file tells its own layout before the bytes that it is about.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  // Bytes that nobody writes are 0.
  virtual Status write(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
};

class MemorySink final : public ByteSink {
 public:
  Status write(std::uint64_t offset, std::span<const std::byte> bytes) override {
    const std::size_t end = static_cast<std::size_t>(offset) + bytes.size();
    if (end > bytes_.size()) bytes_.resize(end);
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    return Done{};
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace crease

// Files for the tests of sources and hosts.
#pragma once

#include "crease/async_source.h"
#include "crease/build.h"
#include "crease/file.h"
#include "crease/generate.h"
#include "crease/http_source.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

namespace crease {

// Bytes of which no two parts are alike.
inline std::vector<std::byte> some_bytes(std::size_t count, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::vector<std::byte> bytes(count);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 255);
  return bytes;
}

inline std::vector<std::byte> part_of(std::span<const std::byte> bytes, const FileRange& range) {
  const auto part = bytes.subspan(range.offset, range.bytes);
  return {part.begin(), part.end()};
}

// A folder that is gone in the end.
class TestFolder {
 public:
  TestFolder() {
    static std::atomic<int> number{0};
    path_ = std::filesystem::temp_directory_path() /
            ("crease-stream-" + std::to_string(::getpid()) + "-" + std::to_string(number++));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::span<const std::byte> bytes) const {
    std::ofstream out(path_ / name, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return write(name, std::as_bytes(std::span(text)));
  }

 private:
  std::filesystem::path path_;
};

// A city of several bands, as a file.
inline const std::vector<std::byte>& city_bytes() {
  static const std::vector<std::byte> bytes = [] {
    Result<Built> built = build_model(generate_city({.triangles = 40'000}), {});
    REQUIRE(built.ok());
    return built->file_bytes;
  }();
  return bytes;
}

// Retries without waiting for long.
inline HttpOptions hasty() {
  HttpOptions options;
  options.first_pause = options.max_pause = std::chrono::milliseconds(1);
  return options;
}

// Every answer that is outstanding, by ticket.
inline std::map<Ticket, Result<std::vector<std::byte>>> all_answers(AsyncSource& source) {
  std::map<Ticket, Result<std::vector<std::byte>>> answers;
  while (source.wait(std::chrono::minutes(1))) {
    for (AsyncAnswer& answer : source.poll()) {
      const bool is_new = answers.emplace(answer.ticket, std::move(answer.bytes)).second;
      CHECK(is_new);
    }
  }
  return answers;
}

inline std::vector<std::byte> read_all(const ByteSource& source, const FileRange& range) {
  std::vector<std::byte> bytes(range.bytes);
  const Status status = source.read(range.offset, bytes);
  CHECK_MESSAGE(status.ok(), (status.ok() ? "" : status.failure().message));
  return bytes;
}

// Asks for random ranges of `bytes`, all at once, and checks what comes.
inline void check_random_ranges(AsyncSource& source, std::span<const std::byte> bytes, int count) {
  std::mt19937 random(7);
  std::vector<RangeRequest> asked;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t offset = random() % bytes.size();
    asked.push_back({{offset, std::min<std::uint64_t>(random() % 5000, bytes.size() - offset)},
                     static_cast<float>(random() % 3)});
  }
  const Ticket first = source.request(asked);
  const auto answers = all_answers(source);
  REQUIRE(answers.size() == asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto& answer = answers.at(ticket_after(first, i));
    REQUIRE(answer.ok());
    CHECK(*answer == part_of(bytes, asked[i].range));
  }
  CHECK(source.size() == bytes.size());
}

}  // namespace crease

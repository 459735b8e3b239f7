#include "spill/small_pieces.h"
#include "spill/spill_file.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>
#include <thread>
#include <vector>

using namespace crease;
using spill::SpillFile;

namespace {

std::unique_ptr<SpillFile> new_file() {
  Result<std::unique_ptr<SpillFile>> file =
      SpillFile::create(std::filesystem::temp_directory_path());
  REQUIRE(file.ok());
  return *std::move(file);
}

// An allocation that knows what is in it.
struct Filled {
  unsigned char* memory = nullptr;
  std::size_t size = 0;
  int byte = 0;

  void fill() const { std::memset(memory, byte, size); }
  bool is_intact() const {
    return std::all_of(memory, memory + size, [this](unsigned char c) { return c == byte; });
  }
};

// Allocates, fills, looks and frees at random.
template <typename Allocator>
void use(Allocator& allocator, unsigned seed, int steps, std::size_t most) {
  std::mt19937 random(seed);
  std::vector<Filled> all;
  bool is_intact = true, is_aligned = true;  // as by malloc()
  for (int step = 0; step < steps; ++step) {
    if (all.size() < 5 || random() % 2 == 0) {
      const std::size_t size = 1 + random() % most;
      all.push_back({static_cast<unsigned char*>(allocator.allocate(size)), size,
                     static_cast<int>(random() % 256)});
      REQUIRE(all.back().memory != nullptr);
      is_aligned = is_aligned && reinterpret_cast<std::uintptr_t>(all.back().memory) % 16 == 0;
      all.back().fill();
    } else {
      std::swap(all[random() % all.size()], all.back());
      is_intact = is_intact && all.back().is_intact();
      allocator.free(all.back().memory);
      all.pop_back();
    }
  }
  for (const Filled& filled : all) {
    is_intact = is_intact && filled.is_intact();
    allocator.free(filled.memory);
  }
  CHECK(is_intact);
  CHECK(is_aligned);
}

}  // namespace

TEST_CASE("what was unmapped is as it was, and what lies beside it too") {
  const std::unique_ptr<SpillFile> file = new_file();
  std::vector<Filled> all;
  for (int i = 0; i < 40; ++i) {
    const std::size_t size = 100'000 * static_cast<std::size_t>(1 + i % 5);
    all.push_back({static_cast<unsigned char*>(file->allocate(size)), size, i + 1});
    REQUIRE(all.back().memory != nullptr);
    CHECK(file->holds(all.back().memory));
    all.back().fill();
  }
  for (std::uint64_t done = 0; done < file->size(); done += 1 << 20) file->unmap_next(1 << 20);
  for (std::size_t i = 0; i < all.size(); i += 2) file->free(all[i].memory);
  for (std::size_t i = 1; i < all.size(); i += 2) CHECK(all[i].is_intact());
  int on_the_stack = 0;
  CHECK(!file->holds(&on_the_stack));
  CHECK(file->most_used() >= 40u * 300'000u);
  CHECK(file->failure().empty());
}

TEST_CASE("several threads share a file while it is unmapped") {
  const std::unique_ptr<SpillFile> file = new_file();
  const std::unique_ptr<SpillFile> pages_of_pieces = new_file();
  spill::SmallPieces pieces(*pages_of_pieces);
  std::atomic<bool> is_done = false;
  std::thread unmapping([&] {
    while (!is_done) file->unmap_next(1 << 20);
  });
  std::vector<std::thread> users;
  for (unsigned seed = 0; seed < 3; ++seed) {
    users.emplace_back([&file, &pieces, seed] {
      use(*file, seed, 600, 300'000);
      use(pieces, seed, 20000, 2000);
    });
  }
  for (std::thread& user : users) user.join();
  is_done = true;
  unmapping.join();
}

TEST_CASE("without room an allocation fails, says where, and others go on") {
  const std::unique_ptr<SpillFile> file = new_file();
  const Filled first{static_cast<unsigned char*>(file->allocate(1 << 20)), 1 << 20, 3};
  REQUIRE(first.memory != nullptr);
  first.fill();

  // A limit on file sizes stands in for a full disk.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{SpillFile::kGrowth + 10'000'000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &full);
  void* too_large = file->allocate(SpillFile::kGrowth + 20'000'000);
  const Filled fitting{static_cast<unsigned char*>(file->allocate(SpillFile::kGrowth)),
                       SpillFile::kGrowth, 4};
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);

  CHECK(too_large == nullptr);
  CHECK(file->failure().find(std::filesystem::temp_directory_path().string()) == 0);
  REQUIRE(fitting.memory != nullptr);  // beyond a step, as far as there is room
  fitting.fill();
  CHECK(first.is_intact());
  CHECK(fitting.is_intact());
  file->free(fitting.memory);
  file->free(first.memory);
}

TEST_CASE("a folder that is not there is a failure with its name") {
  const Result<std::unique_ptr<SpillFile>> file = SpillFile::create("/no/such/folder");
  REQUIRE(!file.ok());
  CHECK(file.failure().error == Error::WriteFailed);
  CHECK(file.failure().message.find("/no/such/folder") == 0);
}

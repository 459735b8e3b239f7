#include "parallel/parallel.h"

#include "parallel/shared_progress.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <numeric>
#include <random>
#include <stdexcept>

using namespace crease;

TEST_CASE("a loop does every index once, whatever the grain and the threads") {
  for (int threads : {0, 1, 2, 7}) {
    for (std::size_t grain : {1, 7, 5000}) {
      CAPTURE(threads);
      CAPTURE(grain);
      const std::vector<int> times = run_on(threads, [&] {
        std::vector<int> done(1000);  // plain ints: the thread sanitizer sees a second visitor
        parallel_ranges(done.size(), grain, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++done[i];
        });
        return done;
      });
      CHECK(times == std::vector<int>(1000, 1));
    }
  }
  parallel_for(0, [](std::size_t) { FAIL("no index"); });
}

// What one loop wrote the next one reads on other threads, and the caller writes in between.
TEST_CASE("loops that follow each other see each other's work") {
  constexpr std::size_t kCount = 256;
  const std::uint64_t sum = run_on(7, [] {
    std::vector<std::uint64_t> values(kCount, 1);
    for (std::size_t step = 0; step < 50; ++step) {
      std::vector<std::uint64_t> next(kCount);
      parallel_for(kCount, [&](std::size_t i) { next[i] = values[kCount - 1 - i] + step; });
      values = std::move(next);
      values[0] += 1;
    }
    return std::accumulate(values.begin(), values.end(), std::uint64_t{0});
  });
  CHECK(sum == kCount * (1 + 49 * 50 / 2) + 50);
}

namespace {

std::uint64_t sum_of(const std::vector<std::uint64_t>& values, std::size_t begin, std::size_t end) {
  if (end - begin <= 3) {
    return std::accumulate(values.begin() + std::ptrdiff_t(begin),
                           values.begin() + std::ptrdiff_t(end), std::uint64_t{0});
  }
  const std::size_t middle = begin + (end - begin) / 2;
  std::uint64_t left = 0, right = 0;
  parallel_both([&] { left = sum_of(values, begin, middle); },
                [&] { right = sum_of(values, middle, end); });
  return left + right;
}

}  // namespace

TEST_CASE("pairs of tasks nest") {
  std::vector<std::uint64_t> values(1000);
  std::iota(values.begin(), values.end(), 0u);
  for (int threads : {1, 2, 7}) {
    CHECK(run_on(threads, [&] { return sum_of(values, 0, values.size()); }) == 999 * 1000 / 2);
  }
}

TEST_CASE("parallel_sort sorts") {
  std::mt19937 random(1);
  for (std::size_t count : {0, 1, 4095, 4096, 4097, 100'000}) {
    CAPTURE(count);
    std::vector<std::uint32_t> values(count);
    for (std::uint32_t& value : values) value = std::uint32_t(random() % (count / 2 + 1));
    std::vector<std::uint32_t> expected = values;
    std::sort(expected.begin(), expected.end(), std::greater<>());
    run_on(7, [&] {
      parallel_sort(values, std::greater<>());
      return true;
    });
    CHECK(values == expected);
  }
}

TEST_CASE("every thread has its own value, and keeps it") {
  static std::atomic<int> alive;
  struct Scratch {
    Scratch() { ++alive; }
    ~Scratch() { --alive; }
    std::size_t uses = 0;  // no atomic: nobody else may touch it
  };
  {
    PerThread<Scratch> scratch;
    std::atomic<std::size_t> first_uses{0};
    run_on(7, [&] {
      for (int round = 0; round < 3; ++round) {
        parallel_for(500, [&](std::size_t) {
          if (scratch.local().uses++ == 0) ++first_uses;
        });
      }
      return true;
    });
    CHECK(alive > 0);
    CHECK(alive == int(first_uses));
  }
  CHECK(alive == 0);
}

TEST_CASE("what a task throws reaches the caller") {
  CHECK_THROWS_AS(run_on(2,
                         [] {
                           parallel_for(100, [](std::size_t i) {
                             if (i == 42) throw std::runtime_error("42");
                           });
                           return true;
                         }),
                  std::runtime_error);
}

TEST_CASE("progress that has asked to stop is not told more") {
  int told = 0;
  const ProgressCallback callback = [&](const char*, double) { return ++told < 3; };
  run_on(7, [&] {
    SharedProgress progress(callback, "stage", 10'000);
    parallel_for(10'000, [&](std::size_t) { progress.advance(1); });
    CHECK(progress.stopped());
    return true;
  });
  CHECK(told == 3);
}

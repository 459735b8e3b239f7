// Words, histories, keys, work in the background.
#include "view/background.h"
#include "view/histories.h"
#include "view/keys.h"
#include "view/words.h"

#include <doctest/doctest.h>

#include <set>

namespace crease {

TEST_CASE("numbers are written for people") {
  CHECK(grouped(0) == "0");
  CHECK(grouped(999) == "999");
  CHECK(grouped(1000) == "1 000");
  CHECK(grouped(1234567) == "1 234 567");
  CHECK(in_bytes(999) == "999 B");
  CHECK(in_bytes(12'340) == "12.3 kB");
  CHECK(in_bytes(5'000'000'000) == "5 GB");
}

TEST_CASE("the median is of all frames, a graph of the last ones") {
  Histories histories;
  CHECK(histories.median_frame_ms() == 0);
  for (int i = 1; i <= 1001; ++i) histories.add(i, {});
  CHECK(histories.frame_count() == 1001);
  CHECK(histories.median_frame_ms() == doctest::Approx(501));
  const Histories::View view = histories.of(Series::FrameMs);
  CHECK(view.last == 1001);
  CHECK(view.largest == 1001);
  CHECK(view.values[view.oldest] == 1001 - kHistoryLength + 1);
}

TEST_CASE("no two actions share a key, and every key finds its action") {
  std::set<int> codes;
  for (const KeyRow& row : key_rows()) {
    for (const int code : {row.code, row.other_code}) {
      if (code == 0) continue;
      CHECK(codes.insert(code).second);
      CHECK(action_of(code) == row.action);
    }
  }
  const FlyKeys keys = fly_keys();
  for (const int code : {keys.right, keys.left, keys.above, keys.below, keys.ahead, keys.back}) {
    CHECK_FALSE(codes.contains(code));
  }
}

TEST_CASE("work in the background ends by itself, or when nobody wants it any more") {
  Background<int> quick([](Note& note) -> Result<int> {
    note.say("counting", 0.5);
    return 7;
  });
  while (!quick.is_done()) std::this_thread::yield();
  CHECK(quick.note().stage() == "counting");
  CHECK(*quick.take() == 7);

  std::atomic<bool> was_stopped{false};
  {
    const Background<int> endless([&](Note& note) -> Result<int> {
      const ProgressCallback progress = note.progress();
      while (progress("waiting", 0)) std::this_thread::yield();
      was_stopped = true;
      return fail(Error::Interrupted, "interrupted");
    });
  }
  CHECK(was_stopped);
}

}  // namespace crease

// Sources that ask for so many bytes a second at most.
#include "crease/limited_source.h"

#include "crease/block_streamer.h"
#include "crease/file_server.h"
#include "stream/stream_files.h"

#include <algorithm>

namespace crease {
namespace {

using Clock = RateLimit::Clock;
using std::chrono::milliseconds;

// Nothing passes again before the end of days.
constexpr double kHardlyAny = 1e-6;

TEST_CASE("a bucket lets so many bytes pass, and as many more as time brings") {
  RateLimit limit(1000);
  const Clock::time_point begin = Clock::now();
  CHECK(limit.take(200, begin));
  CHECK(limit.take(500, begin));  // more than there is: it is owed
  CHECK_FALSE(limit.take(1, begin + milliseconds(300)));
  CHECK(limit.pause(begin + milliseconds(300)) > milliseconds(100));
  CHECK(limit.take(1, begin + milliseconds(600)));
  // It never holds more than a quarter of a second brings.
  std::uint64_t passed = 0;
  for (int i = 0; i < 1000; ++i) passed += limit.take(1, begin + std::chrono::hours(1)) ? 1 : 0;
  CHECK(passed == 250);
}

TEST_CASE("over many seconds what passes is what the limit says") {
  RateLimit limit(10'000);
  const Clock::time_point begin = Clock::now();
  std::uint64_t passed = 0;
  for (int ms = 0; ms < 20'000; ms += 7) {
    while (limit.take(900, begin + milliseconds(ms))) passed += 900;
  }
  CHECK(passed >= 199'000);
  CHECK(passed <= 204'000);
}

TEST_CASE("without a limit everything passes, and the limit may come and go") {
  RateLimit limit;
  for (int i = 0; i < 100; ++i) CHECK(limit.take(~0ull));
  limit.set(kHardlyAny);
  CHECK_FALSE(limit.take(1));
  limit.set(0);
  CHECK(limit.take(1));
}

TEST_CASE("each range is answered once, with its bytes, at any limit") {
  const std::vector<std::byte> bytes = some_bytes(1 << 18);
  const TestFolder folder;
  const std::filesystem::path path = folder.write("model.crease", bytes);
  const std::unique_ptr<FileServer> server = *FileServer::start(folder.path());
  for (const double rate : {0.0, 20e6, 2e6}) {
    for (const AsyncSourcePtr& beneath :
         {async_memory_source(bytes, "memory"), *open_async_file(path),
          open_async_http(server->url() + "model.crease", hasty())}) {
      const AsyncSourcePtr source = limited_source(beneath, std::make_shared<RateLimit>(rate));
      CAPTURE(source->name());
      check_random_ranges(*source, bytes, 100);
      CHECK(source->statistics().asked == 100);
      CHECK(source->statistics().answered == 100);
    }
  }
}

TEST_CASE("the most urgent range passes first, as far as the limit goes") {
  const std::vector<std::byte> bytes = some_bytes(1000);
  const auto limit = std::make_shared<RateLimit>(kHardlyAny);
  const AsyncSourcePtr source = limited_source(async_memory_source(bytes), limit);
  source->request(FileRange{0, 10});  // takes what was in the bucket
  REQUIRE(source->poll().size() == 1);
  const RangeRequest asked[] = {{{0, 100}, 1}, {{100, 100}, 3}, {{200, 100}, 2}};
  const Ticket first = source->request(asked);
  CHECK(source->poll().empty());
  CHECK_FALSE(source->wait(milliseconds(5)));
  source->prioritize(ticket_after(first, 2), 9);
  source->cancel(ticket_after(first, 1));
  CHECK(source->statistics().asked == 4);
  CHECK(source->statistics().cancelled == 1);
  CHECK(source->statistics().bytes_asked == 310);
  limit->set(0);
  const std::vector<AsyncAnswer> answers = source->poll();
  REQUIRE(answers.size() == 2);
  CHECK(answers[0].ticket == ticket_after(first, 2));
  CHECK(answers[1].ticket == first);
  CHECK_FALSE(source->wait(std::chrono::hours(1)));  // nothing is outstanding
}

TEST_CASE("sources that share a limit have it together") {
  const std::vector<std::byte> bytes = some_bytes(1000);
  const auto limit = std::make_shared<RateLimit>(kHardlyAny);
  const AsyncSourcePtr one = limited_source(async_memory_source(bytes), limit);
  const AsyncSourcePtr other = limited_source(async_memory_source(bytes), limit);
  one->request(FileRange{0, 10});
  other->request(FileRange{0, 10});
  CHECK(one->poll().size() == 1);
  CHECK(other->poll().empty());
}

TEST_CASE("a model streams through a limit, and opening it can be stopped") {
  const std::vector<std::byte> bytes = some_bytes(1000);  // no model
  const auto limit = std::make_shared<RateLimit>(kHardlyAny);
  CHECK(limit->take(1));
  int asked = 0;
  const Result<BlockStreamer> stopped =
      BlockStreamer::open(limited_source(async_memory_source(bytes), limit),
                          {.decode_threads = 0, .stopped = [&] { return ++asked > 1; }});
  REQUIRE(!stopped.ok());
  CHECK(stopped.failure().error == Error::Interrupted);
  CHECK(asked == 2);
  limit->set(0);
  const Result<BlockStreamer> opened =
      BlockStreamer::open(limited_source(async_memory_source(bytes), limit), {.decode_threads = 0});
  REQUIRE(!opened.ok());
  CHECK(opened.failure().error == Error::NotCrease);
}

}  // namespace
}  // namespace crease

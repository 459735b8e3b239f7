// Asynchronous sources of every kind.
#include "crease/async_source.h"

#include "crease/file_server.h"
#include "stream/stream_files.h"

#include <thread>

namespace crease {
namespace {

// The same bytes from memory, a file, any byte source, and a host.
struct Everywhere {
  std::vector<std::byte> bytes = some_bytes(1 << 20);
  TestFolder folder;
  std::filesystem::path path = folder.write("model.crease", bytes);
  std::unique_ptr<FileServer> server = *FileServer::start(folder.path());

  std::vector<AsyncSourcePtr> sources() const {
    return {async_memory_source(bytes, "memory"), *open_async_file(path),
            async_source(memory_source(bytes, "other")),
            open_async_http(server->url() + "model.crease", hasty())};
  }
};

TEST_CASE("each range is answered once, with its bytes, by every source") {
  const Everywhere everywhere;
  for (const AsyncSourcePtr& source : everywhere.sources()) {
    CAPTURE(source->name());
    check_random_ranges(*source, everywhere.bytes, 300);
    const AsyncStatistics told = source->statistics();
    CHECK(told.asked == 300);
    CHECK(told.answered == 300);
    CHECK(told.requests < 100);
    CHECK(told.latency_max_seconds >= told.latency_mean_seconds);
  }
}

TEST_CASE("a range beyond the end fails alone, with the name of the source") {
  const Everywhere everywhere;
  const std::uint64_t size = everywhere.bytes.size();
  for (const AsyncSourcePtr& source : everywhere.sources()) {
    CAPTURE(source->name());
    const RangeRequest asked[] = {
        {{size - 200, 100}}, {{size - 100, 200}}, {{size - 100, 100}}, {{~0ull, ~0ull}}};
    const Ticket first = source->request(asked);
    const auto answers = all_answers(*source);
    REQUIRE(answers.size() == 4);
    CHECK(answers.at(first).ok());
    CHECK(answers.at(ticket_after(first, 2)).ok());
    for (const std::size_t i : {1, 3}) {
      const auto& answer = answers.at(ticket_after(first, i));
      REQUIRE(!answer.ok());
      CHECK(answer.failure().error == Error::Truncated);
      CHECK(answer.failure().message.starts_with(source->name() + ": "));
    }
  }
}

TEST_CASE("a range of no bytes is answered once the size is known") {
  const Everywhere everywhere;
  for (const AsyncSourcePtr& source : everywhere.sources()) {
    CAPTURE(source->name());
    const Ticket ticket = source->request(FileRange{});
    const auto answers = all_answers(*source);
    REQUIRE(answers.at(ticket).ok());
    CHECK(answers.at(ticket)->empty());
    CHECK(source->size() == everywhere.bytes.size());
  }
}

TEST_CASE("nothing is outstanding: waiting returns at once") {
  const Everywhere everywhere;
  for (const AsyncSourcePtr& source : everywhere.sources()) {
    CHECK(!source->wait(std::chrono::hours(1)));
    const Ticket ticket = source->request(FileRange{100'000, 10});
    source->cancel(ticket);
    source->wait(std::chrono::hours(1));
    CHECK(source->poll().empty());
  }
}

TEST_CASE("sources go with requests outstanding") {
  const Everywhere everywhere;
  for (const AsyncSourcePtr& source : everywhere.sources()) {
    for (std::uint64_t i = 0; i < 20; ++i) source->request(FileRange{i * 50'000, 40'000});
  }
}

TEST_CASE("several threads ask one source") {
  const Everywhere everywhere;
  for (const AsyncSourcePtr& source : everywhere.sources()) {
    CAPTURE(source->name());
    constexpr int kThreads = 4, kRequests = 50;
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&source, t] {
        for (int i = 0; i < kRequests; ++i) {
          const Ticket ticket =
              source->request(FileRange{static_cast<std::uint64_t>(t * 200'000 + i * 999), 500});
          if (i % 5 == 0) source->cancel(ticket);
          if (i % 7 == 0) source->prioritize(ticket, 2);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    all_answers(*source);
    const AsyncStatistics told = source->statistics();
    CHECK(told.asked == kThreads * kRequests);
    CHECK(told.answered + told.cancelled == told.asked);
  }
}

TEST_CASE("a file that is not there fails when it is opened") {
  const TestFolder folder;
  const auto source = open_async_file(folder.path() / "none.crease");
  REQUIRE(!source.ok());
  CHECK(source.failure().error == Error::NotFound);
}

}  // namespace
}  // namespace crease

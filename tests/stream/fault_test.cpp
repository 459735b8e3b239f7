// Hosts that fail.
#include "stream/fault_host.h"

#include "stream/stream_files.h"

#include <future>
#include <thread>

namespace crease {
namespace {

constexpr std::size_t kBytes = 400'000;
constexpr std::uint64_t kBehindHead = 100'000;

// Sound for the first request.
HostReply head_or(const HostRequest& request, std::span<const std::byte> file,
                  const std::function<HostReply()>& then) {
  return request.number == 0 ? good_reply(request, file) : then();
}

Failure read_failure(const ByteSource& source, const FileRange& range) {
  std::vector<std::byte> into(range.bytes);
  const Status status = source.read(range.offset, into);
  REQUIRE(!status.ok());
  return status.failure();
}

TEST_CASE("a connection that breaks in the middle goes on from there") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    HostReply reply = good_reply(request, file);
    if (request.number % 2 == 0) {  // the first one too
      reply.bytes.resize(reply.bytes.size() / 2);
      reply.then = HostReply::Close;
    }
    return reply;
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK((*source)->size() == kBytes);
  CHECK(read_all(**source, {0, 1000}) == part_of(file, {0, 1000}));
  CHECK(read_all(**source, {kBehindHead, 200'000}) == part_of(file, {kBehindHead, 200'000}));
  for (const HostRequest& request : host.requests()) {
    CHECK(request.range()->offset + request.range()->bytes <= kBytes);
    if (request.number > 0) CHECK(request.field("if-range") == "\"one\"");
  }
  CHECK(host.requests()[1].range()->offset > 0);  // not from the begin
  CHECK((*source)->bytes_read() == 65536 + 200'000);
}

TEST_CASE("a host that always breaks fails with its URL and how often it was asked") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    return head_or(request, file, [] { return HostReply{"", HostReply::Close}; });
  });
  HttpOptions options = hasty();
  options.max_retries = 2;
  const Result<ByteSourcePtr> source = open_http_source(host.url(), options);
  REQUIRE(source.ok());
  CHECK(read_failure(**source, {kBehindHead, 10}).message.ends_with("(3 attempts)"));
  CHECK(host.requests().size() >= 4);  // the library may try a fresh connection by itself

  const AsyncSourcePtr async = open_async_http(host.url(), options);
  const Ticket ticket = async->request(FileRange{kBehindHead, 10});
  const Result<std::vector<std::byte>> answer = all_answers(*async).at(ticket);
  REQUIRE(!answer.ok());
  CHECK(answer.failure().error == Error::ReadFailed);
  CHECK(answer.failure().message.starts_with(host.url() + ": "));
}

TEST_CASE("a host that restarts is found again") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) { return good_reply(request, file); });
  HttpOptions options = hasty();
  options.first_pause = options.max_pause = std::chrono::milliseconds(20);
  options.max_retries = 1000;
  const Result<ByteSourcePtr> source = open_http_source(host.url(), options);
  REQUIRE(source.ok());
  host.shut();
  auto bytes = std::async(std::launch::async, [&] {
    return read_all(**source, {kBehindHead, 1000});
  });
  CHECK(bytes.wait_for(std::chrono::milliseconds(60)) == std::future_status::timeout);
  host.open_again();
  CHECK(bytes.get() == part_of(file, {kBehindHead, 1000}));
}

TEST_CASE("nobody listens: the failure says so") {
  std::string url;
  {
    FaultHost host([](const HostRequest&) { return HostReply{}; });
    url = host.url();
  }
  HttpOptions options = hasty();
  options.max_retries = 1;
  const Result<ByteSourcePtr> source = open_http_source(url, options);
  REQUIRE(!source.ok());
  CHECK(source.failure().error == Error::ReadFailed);
  CHECK(source.failure().message.starts_with(url + ": "));
  CHECK(source.failure().message.ends_with("(2 attempts)"));
}

TEST_CASE("statuses that pass are asked again, others are not") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  for (const char* status : {"500 Oops", "502 Bad Gateway", "503 Busy", "429 Too Many Requests"}) {
    CAPTURE(status);
    FaultHost host([&](const HostRequest& request) {
      if (request.number % 3 != 2) return reply(status, "Retry-After: 0\r\n", "sorry");
      return good_reply(request, file);
    });
    const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
    REQUIRE(source.ok());
    CHECK(read_all(**source, {kBehindHead, 10}) == part_of(file, {kBehindHead, 10}));
    CHECK(host.requests().size() == 6);
  }
  FaultHost host([&](const HostRequest&) { return reply("404 Not Found", "", "no"); });
  const Result<ByteSourcePtr> none = open_http_source(host.url(), hasty());
  REQUIRE(!none.ok());
  CHECK(none.failure().error == Error::NotFound);
  CHECK(none.failure().message == host.url() + ": the host answers with status 404");
  CHECK(host.requests().size() == 1);
}

TEST_CASE("a host that says when to come back is obeyed") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    if (request.number == 0) return reply("503 Busy", "Retry-After: 3600\r\n", "");
    return good_reply(request, file);
  });
  HttpOptions options = hasty();
  options.max_pause = std::chrono::milliseconds(30);  // but not for an hour
  CHECK(open_http_source(host.url(), options).ok());
}

TEST_CASE("a host that trickles counts as broken") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  std::atomic<bool> has_trickled{false};
  FaultHost host([&](const HostRequest& request) {
    HostReply reply = good_reply(request, file);
    if (request.range()->offset == kBehindHead && !has_trickled.exchange(true)) {
      reply.bytes.resize(reply.bytes.size() - 100'000);
      reply.then = HostReply::Hang;
    }
    return reply;
  });
  HttpOptions options = hasty();
  options.low_speed_seconds = 1;
  options.low_speed_bytes = 10'000'000;  // what came at once is too slow within a second then
  const Result<ByteSourcePtr> source = open_http_source(host.url(), options);
  REQUIRE(source.ok());
  CHECK(read_all(**source, {kBehindHead, 200'000}) == part_of(file, {kBehindHead, 200'000}));
  CHECK(has_trickled);
  CHECK(host.requests().back().range()->offset == kBehindHead + 100'000);
}

TEST_CASE("a file that is replaced under way fails as such, from then on") {
  const std::vector<std::byte> file = some_bytes(kBytes), other = some_bytes(kBytes, 2);
  for (const bool obeys_if_range : {false, true}) {
    FaultHost host([&](const HostRequest& request) {
      return head_or(request, file, [&] {
        HostRequest asked = request;
        if (obeys_if_range) asked.head = "GET / HTTP/1.1\r\n\r\n";  // all of the other one
        return good_reply(asked, other, "\"two\"");
      });
    });
    const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
    REQUIRE(source.ok());
    for (int i = 0; i < 2; ++i) {
      const Failure failure = read_failure(**source, {kBehindHead, 10});
      CHECK(failure.error == Error::Replaced);
      CHECK(failure.message ==
            "the file was replaced while it was read: its ETag was \"one\" and is \"two\"; open it "
            "again");
    }
    CHECK(host.requests().size() == 2);
    CHECK(read_all(**source, {0, 10}) == part_of(file, {0, 10}));  // of the head that is kept
  }
}

TEST_CASE("a wrong range is no answer") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    HostRequest other = request;
    other.head = "GET / HTTP/1.1\r\nRange: bytes=0-9\r\n\r\n";
    return head_or(request, file, [&] { return good_reply(other, file); });
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  const Failure failure = read_failure(**source, {kBehindHead, 10});
  CHECK(failure.error == Error::ReadFailed);
  CHECK(failure.message ==
        "bytes from 100000 on were asked for, the host answers with \"bytes 0-9/400000\"");
  CHECK(host.requests().size() == 2);
}

TEST_CASE("416 for bytes that should be there") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    return head_or(request, file, [] {
      return reply("416 Range Not Satisfiable", "Content-Range: bytes */70000\r\n", "");
    });
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK(read_failure(**source, {kBehindHead, 10}).error == Error::Replaced);  // became shorter
}

TEST_CASE("answers shorter than asked are asked on") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    HostRequest shorter = request;
    const FileRange range = *request.range();
    shorter.head = "GET / HTTP/1.1\r\nRange: bytes=" + std::to_string(range.offset) + "-" +
                   std::to_string(range.offset + std::min<std::uint64_t>(range.bytes, 1000) - 1) +
                   "\r\n\r\n";
    return good_reply(shorter, file);
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK(read_all(**source, {kBehindHead, 3500}) == part_of(file, {kBehindHead, 3500}));
  CHECK(host.requests().size() == 5);
}

TEST_CASE("answers come in any order, to the right question") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  std::promise<void> gate;
  std::shared_future<void> opened = gate.get_future().share();
  FaultHost host([&](const HostRequest& request) {
    if (request.range()->offset == 150'000) opened.wait();
    return good_reply(request, file);
  });
  const AsyncSourcePtr source = open_async_http(host.url(), hasty());
  const RangeRequest asked[] = {{{150'000, 100}, 1}, {{300'000, 100}, 0}};
  const Ticket first = source->request(asked);
  REQUIRE(source->wait(std::chrono::minutes(1)));
  const std::vector<AsyncAnswer> early = source->poll();
  REQUIRE(early.size() == 1);
  CHECK(early[0].ticket == ticket_after(first, 1));
  CHECK(*early[0].bytes == part_of(file, {300'000, 100}));
  gate.set_value();
  CHECK(*all_answers(*source).at(first) == part_of(file, {150'000, 100}));
}

TEST_CASE("polling and asking never wait for a host that is silent") {
  FaultHost host([](const HostRequest&) { return HostReply{"", HostReply::Hang}; });
  HttpOptions options;
  options.low_speed_seconds = 600;
  const AsyncSourcePtr source = open_async_http(host.url(), options);
  host.wait_for_requests(1);
  const Ticket ticket = source->request(FileRange{0, 10});
  CHECK(source->poll().empty());
  CHECK(!source->size());
  CHECK(!source->wait(std::chrono::milliseconds(1)));
  source->cancel(ticket);
  CHECK(source->statistics().cancelled == 1);
}

TEST_CASE("a large range that nobody wants any more is cut") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    HostReply reply = good_reply(request, file);
    if (request.number == 1) {
      reply.bytes.resize(2000);
      reply.then = HostReply::Hang;
    }
    return reply;
  });
  HttpOptions options = hasty();
  options.low_speed_seconds = 600;
  options.async.max_in_flight = 1;
  const AsyncSourcePtr source = open_async_http(host.url(), options);
  const Ticket large = source->request(FileRange{kBehindHead, 200'000});
  host.wait_for_requests(2);
  source->cancel(large);
  const Ticket small = source->request(FileRange{kBehindHead, 10});  // has to wait for its turn
  CHECK(*all_answers(*source).at(small) == part_of(file, {kBehindHead, 10}));
}

TEST_CASE("a blocking read can be stopped") {
  FaultHost host([](const HostRequest&) { return HostReply{"", HostReply::Hang}; });
  HttpOptions options;
  options.stopped = [] { return true; };
  const Result<ByteSourcePtr> source = open_http_source(host.url(), options);
  REQUIRE(!source.ok());
  CHECK(source.failure().error == Error::Interrupted);
}

// The host ignores ranges.
HostReply whole_reply(const HostRequest& request, std::span<const std::byte> file) {
  HostRequest whole = request;
  whole.head = "GET / HTTP/1.1\r\n\r\n";
  return good_reply(whole, file);
}

TEST_CASE("a host without ranges is read from the begin on, once") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) { return whole_reply(request, file); });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK((*source)->size() == kBytes);
  CHECK(read_all(**source, {kBehindHead, 1000}) == part_of(file, {kBehindHead, 1000}));
  CHECK(read_all(**source, {0, kBytes}) == file);
  CHECK(host.requests().size() == 1);
  CHECK((*source)->bytes_read() == kBytes);
}

TEST_CASE("a host without ranges that breaks is read again, and what is there is kept") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    HostReply reply = whole_reply(request, file);
    if (request.number == 0) {
      reply.bytes.resize(150'000);
      reply.then = HostReply::Close;
    }
    return reply;
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK(read_all(**source, {0, kBytes}) == file);
  CHECK(host.requests().size() == 2);
}

TEST_CASE("a host that tells no length is read to the end") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest&) {
    return HostReply{"HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n" + text_of(file),
                     HostReply::Close};
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK((*source)->size() == kBytes);
  CHECK(read_all(**source, {0, kBytes}) == file);
}

TEST_CASE("a host without ranges and a file beyond the limit") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) { return whole_reply(request, file); });
  HttpOptions options = hasty();
  options.max_whole_bytes = 200'000;
  const Result<ByteSourcePtr> source = open_http_source(host.url(), options);
  REQUIRE(source.ok());  // the head is there
  CHECK(read_all(**source, {0, 100}) == part_of(file, {0, 100}));
  CHECK(read_failure(**source, {300'000, 10}).error == Error::OverLimit);
}

TEST_CASE("a host that promises more than there can be takes no memory for it") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  for (const char* head :
       {"HTTP/1.1 200 OK\r\nContent-Length: 9000000000000000000\r\n\r\n",
        "HTTP/1.1 206 Partial Content\r\nContent-Length: 9000000000000000000\r\n"
        "Content-Range: bytes 0-8999999999999999999/9000000000000000000\r\n\r\n"}) {
    FaultHost host([&](const HostRequest& request) {
      return request.number == 0 ? HostReply{head + text_of(file), HostReply::Close}
                                 : HostReply{"", HostReply::Close};
    });
    const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
    REQUIRE(source.ok());
    CHECK((*source)->size() == 9'000'000'000'000'000'000);
    CHECK(read_all(**source, {0, 65536}) == part_of(file, {0, 65536}));
    CHECK(read_failure(**source, {1'000'000'000, 10}).error == Error::ReadFailed);
  }
}

TEST_CASE("a whole file for one part, once ranges are known to work") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost host([&](const HostRequest& request) {
    return head_or(request, file, [&] { return whole_reply(request, file); });
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK(read_all(**source, {kBehindHead, 10}) == part_of(file, {kBehindHead, 10}));
}

TEST_CASE("a failed opening is tried again by the next request") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  std::atomic<bool> is_there{false};
  FaultHost host([&](const HostRequest& request) {
    return is_there ? good_reply(request, file) : reply("404 Not Found", "", "no");
  });
  const AsyncSourcePtr source = open_async_http(host.url(), hasty());
  const Ticket early = source->request(FileRange{0, 10});
  CHECK(all_answers(*source).at(early).failure().error == Error::NotFound);
  is_there = true;
  const Ticket late = source->request(FileRange{0, 10});
  CHECK(*all_answers(*source).at(late) == part_of(file, {0, 10}));
}

TEST_CASE("an opening that failed before anybody asked answers the first request") {
  FaultHost host([](const HostRequest&) { return reply("404 Not Found", "", "no"); });
  const AsyncSourcePtr source = open_async_http(host.url(), hasty());
  while (source->statistics().bytes_transferred == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const Ticket ticket = source->request(FileRange{0, 10});
  CHECK(all_answers(*source).at(ticket).failure().error == Error::NotFound);
  CHECK(host.requests().size() == 1);
}

TEST_CASE("redirects are followed, to http and https alone") {
  const std::vector<std::byte> file = some_bytes(kBytes);
  FaultHost target([&](const HostRequest& request) { return good_reply(request, file); });
  FaultHost host([&](const HostRequest&) {
    return reply("302 Found", "Location: " + target.url() + "\r\n", "over there");
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  CHECK(read_all(**source, {kBehindHead, 10}) == part_of(file, {kBehindHead, 10}));

  FaultHost to_file([](const HostRequest&) {
    return reply("302 Found", "Location: file:///etc/passwd\r\n", "");
  });
  const Result<ByteSourcePtr> refused = open_http_source(to_file.url(), hasty());
  REQUIRE(!refused.ok());
  CHECK(refused.failure().error == Error::ReadFailed);
  CHECK(to_file.requests().size() == 1);
}

}  // namespace
}  // namespace crease

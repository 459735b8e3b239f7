// Models over HTTP, from the server of `crease serve`.
#include "crease/http_source.h"

#include "crease/block_streamer.h"
#include "crease/file_server.h"
#include "http/url.h"
#include "stream/fault_host.h"
#include "stream/stream_files.h"

#include <mutex>
#include <thread>

namespace crease {
namespace {

// A host that counts what it was asked.
struct Host {
  TestFolder folder;
  std::mutex lock;
  std::vector<ServedRequest> told;
  std::unique_ptr<FileServer> server =
      *FileServer::start(folder.path(), {.on_request = [this](const ServedRequest& request) {
                           const std::lock_guard guard(lock);
                           told.push_back(request);
                         }});

  std::string url() const { return server->url() + "model.crease"; }
  std::size_t request_count() {
    const std::lock_guard guard(lock);
    return told.size();
  }
  std::uint64_t sent_bytes() {
    const std::lock_guard guard(lock);
    std::uint64_t bytes = 0;
    for (const ServedRequest& request : told) bytes += request.bytes;
    return bytes;
  }
};

bool is_same(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

TEST_CASE("a model over HTTP is the model") {
  Host host;
  host.folder.write("model.crease", city_bytes());
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  const Result<BlockFile> remote = BlockFile::open(*source);
  REQUIRE(remote.ok());
  const Result<BlockFile> local = BlockFile::open(memory_source(city_bytes()));
  const Result<DecodedModel> a = decode_model(*remote), b = decode_model(*local);
  REQUIRE(a.ok());
  CHECK(is_same(a->mesh, b->mesh));
  CHECK(a->blocks == b->blocks);
  CHECK((*source)->bytes_read() == host.sent_bytes());
  // Each band's blocks are neighbours: a request a band, instead of one a block.
  CHECK(a->blocks.size() > 10);
  CHECK(host.request_count() <= 2 + remote->facts().bands.size());
  CHECK(host.sent_bytes() <= city_bytes().size() * 11 / 10);

  const std::size_t before = host.request_count();
  CHECK(decode_model(*remote).ok());  // once more, from what was kept
  CHECK(host.request_count() == before);
}

TEST_CASE("a coarse level reads the first bytes alone") {
  Host host;
  host.folder.write("model.crease", city_bytes());
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  const Result<BlockFile> file = BlockFile::open(*source);
  REQUIRE(file.ok());
  const auto coarsest = static_cast<std::uint16_t>(file->facts().bands.size());
  CHECK(decode_model(*file, {.finest_band = coarsest, .part_names = false}).ok());
  CHECK(host.request_count() == 1);
  CHECK((*source)->bytes_read() == 65536);
}

TEST_CASE("the first picture is in the first 64 KiB") {
  Host host;
  host.folder.write("model.crease", city_bytes());
  Result<BlockStreamer> streamer = BlockStreamer::open(open_async_http(host.url(), hasty()));
  REQUIRE(streamer.ok());
  BlockViewParameters nothing;  // but the base
  nothing.view.max_triangles = 0;
  while (streamer->mesh().shown().empty()) {
    streamer->update(nothing);
    streamer->wait(std::chrono::milliseconds(100));
  }
  // With that view complete, the names of parts may be on their way.
  const std::uint64_t names = streamer->head().parts.range.bytes;
  CHECK((host.sent_bytes() == 65536 || host.sent_bytes() == 65536 + names));
  CHECK(host.request_count() <= 2);
}

TEST_CASE("many small ranges become few requests") {
  Host host;
  const std::vector<std::byte> bytes = some_bytes(2'000'000);
  host.folder.write("model.crease", bytes);
  const AsyncSourcePtr source = open_async_http(host.url(), hasty());
  std::vector<RangeRequest> asked;
  for (std::uint64_t i = 0; i < 500; ++i) asked.push_back({{100'000 + i * 3000, 1000}});
  const Ticket first = source->request(asked);
  const auto answers = all_answers(*source);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    CHECK(*answers.at(ticket_after(first, i)) == part_of(bytes, asked[i].range));
  }
  CHECK(host.request_count() == 3);  // the head, then 1.5 MB in pieces of 1 MiB at most
  const AsyncStatistics told = source->statistics();
  CHECK(told.requests == 3);
  CHECK(told.bytes_asked == 500'000);
  CHECK(told.bytes_transferred == host.sent_bytes());
  CHECK(told.retries == 0);
}

TEST_CASE("a file smaller than the first request, and an empty one") {
  for (const std::size_t size : {std::size_t(0), std::size_t(1), std::size_t(65535),
                                 std::size_t(65536), std::size_t(65537)}) {
    CAPTURE(size);
    Host host;
    const std::vector<std::byte> bytes = some_bytes(size);
    host.folder.write("model.crease", bytes);
    const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
    REQUIRE(source.ok());
    CHECK((*source)->size() == size);
    CHECK(read_all(**source, {0, size}) == bytes);
    std::vector<std::byte> more(1);
    CHECK((*source)->read(size, more).failure().error == Error::Truncated);
  }
}

TEST_CASE("a file that is replaced on disk under way is noticed") {
  Host host;
  host.folder.write("model.crease", some_bytes(300'000));
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  REQUIRE(source.ok());
  host.folder.write("new", some_bytes(300'000, 2));
  std::filesystem::rename(host.folder.path() / "new", host.folder.path() / "model.crease");
  std::vector<std::byte> into(10);
  const Status status = (*source)->read(200'000, into);
  REQUIRE(!status.ok());
  CHECK(status.failure().error == Error::Replaced);
}

TEST_CASE("a byte that was changed on the way is noticed by the block's checksum") {
  const std::vector<std::byte>& bytes = city_bytes();
  const Result<BlockFile> local = BlockFile::open(memory_source(bytes));
  const BlockEntry last = local->read_page(local->page_count() - 1)->blocks.back();
  FaultHost host([&](const HostRequest& request) {
    std::vector<std::byte> changed = bytes;
    changed[last.offset + last.bytes / 2] ^= std::byte{1};
    return good_reply(request, changed);
  });
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  const Result<BlockFile> file = BlockFile::open(*source);
  REQUIRE(file.ok());
  const Result<DecodedModel> model = decode_model(*file);
  REQUIRE(!model.ok());
  CHECK(model.failure().error == Error::BadChecksum);
  CHECK(model.failure().message.starts_with(host.url() + ": block "));
}

TEST_CASE("several threads read one source") {
  Host host;
  const std::vector<std::byte> bytes = some_bytes(1'000'000);
  host.folder.write("model.crease", bytes);
  HttpOptions options = hasty();
  options.keep_bytes = 100'000;  // so that some of it is read again
  const Result<ByteSourcePtr> source = open_http_source(host.url(), options);
  REQUIRE(source.ok());
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::uint64_t i = 0; i < 40; ++i) {
        const FileRange range{(t * 7 + i * 13) % 90 * 10'000, 9000};
        const FileRange next[] = {{range.offset + 20'000, 5000}};
        (*source)->prefetch(next);
        std::vector<std::byte> into(range.bytes);
        if (!(*source)->read(range.offset, into).ok() || into != part_of(bytes, range)) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(wrong == 0);
}

TEST_CASE("what is fetched ahead is not fetched again") {
  Host host;
  const std::vector<std::byte> bytes = some_bytes(1'000'000);
  host.folder.write("model.crease", bytes);
  const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
  std::vector<FileRange> ranges;
  for (std::uint64_t i = 0; i < 50; ++i) ranges.push_back({200'000 + i * 2000, 2000});
  (*source)->prefetch(ranges);
  (*source)->prefetch(ranges);
  for (const FileRange& range : ranges) CHECK(read_all(**source, range) == part_of(bytes, range));
  CHECK(host.request_count() == 2);
  CHECK((*source)->bytes_read() == 65536 + 100'000);
}

TEST_CASE("of a range whose begin is there, the rest is asked for") {
  Host host;
  const std::vector<std::byte> bytes = some_bytes(200'000);
  host.folder.write("model.crease", bytes);
  const FileRange cut{60'000, 20'000};  // by the end of the first request
  for (const bool ahead : {false, true}) {
    const Result<ByteSourcePtr> source = open_http_source(host.url(), hasty());
    CHECK(read_all(**source, {0, 65536}) == part_of(bytes, {0, 65536}));
    if (ahead) (*source)->prefetch(std::vector{cut, FileRange{80'000, 1000}});
    CHECK(read_all(**source, cut) == part_of(bytes, cut));
    CHECK(read_all(**source, {80'000, 1000}) == part_of(bytes, {80'000, 1000}));
    CHECK((*source)->bytes_read() == 81'000);
  }
  // What was kept of the begin may have gone until the rest comes: all of it is there in any case.
  HttpOptions small = hasty();
  small.keep_bytes = 70'000;
  const Result<ByteSourcePtr> source = open_http_source(host.url(), small);
  CHECK(read_all(**source, {0, 65536}) == part_of(bytes, {0, 65536}));
  (*source)->prefetch(std::vector{cut});
  const FileRange far{100'000, 69'000};
  CHECK(read_all(**source, far) == part_of(bytes, far));
  CHECK(read_all(**source, cut) == part_of(bytes, cut));
}

TEST_CASE("what is no URL of a host") {
  CHECK(is_http_url("http://a/b"));
  CHECK(is_http_url("https://a/b"));
  CHECK(is_http_url("HTTP://a/b"));
  CHECK(is_http_url("Https://a/b"));
  CHECK(!is_http_url("http:/"));
  CHECK(!is_http_url("ftp://a/b"));
  CHECK(!is_http_url("a/http://b"));
  const Result<ByteSourcePtr> bad = open_http_source("http://", hasty());
  REQUIRE(!bad.ok());
  CHECK(bad.failure().error == Error::ReadFailed);
}

TEST_CASE("a URL is asked for as hosts want it") {
  CHECK(http::url_to_ask("HTTPS://Host/A b/\xc3\xa4.crease?q=1 2") ==
        "https://Host/A%20b/%C3%A4.crease?q=1%202");
  CHECK(http::url_to_ask("http://h\xc3\xa4/%20") == "http://h\xc3\xa4/%20");
  CHECK(http::url_to_ask("http://host") == "http://host");
}

}  // namespace
}  // namespace crease

// What answers mean, without a host.
#include "http/response_reader.h"
#include "http/transferred_bytes.h"
#include "http/url.h"

#include "stream/stream_files.h"

namespace crease {
namespace {

using http::Identity;
using http::ResponseReader;
using http::Verdict;
using Kind = Verdict::Kind;

const Identity kKnown{"\"one\"", "Sun, 06 Nov 1994 08:49:37 GMT", 1000};

struct Outcome {
  Verdict verdict;
  std::string bytes;
};

// `head` with \n alone.
Outcome read(const FileRange& asked, const Identity* known, std::string_view head,
             std::string_view body = {}, bool was_cut = false) {
  ResponseReader reader(asked, known);
  while (!head.empty()) {
    const std::size_t end = head.find('\n') + 1;
    reader.on_header(std::string(head.substr(0, end - 1)) + "\r\n");
    head.remove_prefix(end);
  }
  reader.on_header("\r\n");
  Outcome outcome;
  for (const char c : body) {  // one by one: chunks may end anywhere
    const auto wanted = reader.on_body(std::as_bytes(std::span(&c, 1)));
    outcome.bytes.append(reinterpret_cast<const char*>(wanted.data()), wanted.size());
  }
  outcome.verdict = reader.finish(was_cut);
  return outcome;
}

TEST_CASE("where a redirect led to nothing came: ask again") {
  for (const char* status : {"301", "302", "307", "308"}) {
    const std::string head = std::string("HTTP/1.1 ") + status + " Moved\nLocation: /there\n";
    CHECK(read({100, 5}, &kKnown, head, {}, true).verdict.kind == Kind::Again);
    CHECK(read({100, 5}, &kKnown, head).verdict.kind == Kind::Refused);
  }
  CHECK(read({100, 5}, &kKnown, "HTTP/1.1 404 Gone\n", {}, true).verdict.kind == Kind::Refused);
}

TEST_CASE("a part is what it says it is") {
  const Outcome sound = read({100, 5}, &kKnown,
                             "HTTP/1.1 206 Partial Content\ncontent-RANGE: bytes 100-104/1000\n"
                             "ETag: \"one\"\n",
                             "abcde");
  CHECK(sound.verdict.kind == Kind::Complete);
  CHECK(sound.bytes == "abcde");

  const Outcome shorter =
      read({100, 5}, &kKnown, "HTTP/2 206\nContent-Range: bytes 100-101/1000\n", "ab");
  CHECK(shorter.verdict.kind == Kind::Partial);
  CHECK(shorter.bytes == "ab");

  const Outcome longer =
      read({100, 2}, &kKnown, "HTTP/2 206\nContent-Range: bytes 100-104/1000\n", "abcde");
  CHECK(longer.verdict.kind == Kind::Complete);
  CHECK(longer.bytes == "ab");

  const Outcome cut =
      read({100, 5}, &kKnown, "HTTP/2 206\nContent-Range: bytes 100-104/1000\n", "ab", true);
  CHECK(cut.verdict.kind == Kind::Again);
  CHECK(cut.bytes == "ab");

  const Outcome end =
      read({0, 65536}, nullptr, "HTTP/2 206\nContent-Range: bytes 0-4/5\n", "abcde");
  CHECK(end.verdict.kind == Kind::Complete);
}

TEST_CASE("a wrong part is refused") {
  const char* heads[] = {
      "HTTP/1.1 206 Partial Content\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 99-104/1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 101-104/1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 104-100/1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-1000/1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes */1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-104\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: lines 100-104/1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-99999999999999999999/1000\n",
      "HTTP/1.1 206 Partial Content\nContent-Type: multipart/byteranges; boundary=x\n",
      "HTTP/1.1 416 Range Not Satisfiable\nContent-Range: bytes */1000\n",
  };
  for (const char* head : heads) {
    CAPTURE(head);
    const Outcome outcome = read({100, 5}, &kKnown, head, "abcde");
    CHECK(outcome.verdict.kind == Kind::Refused);
    CHECK(outcome.verdict.failure.error == Error::ReadFailed);
    CHECK(outcome.bytes.empty());
  }
  const Outcome no_size =
      read({0, 5}, nullptr, "HTTP/1.1 206 Partial Content\nContent-Range: bytes 0-4/*\n", "abcde");
  CHECK(no_size.verdict.kind == Kind::Refused);
}

TEST_CASE("another file is noticed by size, ETag or date") {
  const char* heads[] = {
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-104/1000\nETag: \"two\"\n",
      "HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-104/1001\n",
      ("HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-104/1000\n"
       "Last-Modified: Sun, 06 Nov 1994 08:49:38 GMT\n"),
      "HTTP/1.1 200 OK\nContent-Length: 1000\nETag: \"two\"\n",
      "HTTP/1.1 200 OK\nContent-Length: 900\n",
      "HTTP/1.1 416 Range Not Satisfiable\nContent-Range: bytes */50\n",
  };
  for (const char* head : heads) {
    CAPTURE(head);
    const Outcome outcome = read({100, 5}, &kKnown, head, "abcde");
    CHECK(outcome.verdict.kind == Kind::Refused);
    CHECK(outcome.verdict.failure.error == Error::Replaced);
    CHECK(outcome.bytes.empty());
  }
  // A cache may weaken an ETag, and a date may differ where the ETag does not.
  const Outcome same = read({100, 5}, &kKnown,
                            "HTTP/1.1 206 Partial Content\nContent-Range: bytes 100-104/1000\n"
                            "ETag: W/\"one\"\nLast-Modified: Sun, 06 Nov 1994 08:49:38 GMT\n",
                            "abcde");
  CHECK(same.verdict.kind == Kind::Complete);
}

TEST_CASE("a whole file instead of a part is skipped into") {
  const std::string file = "0123456789";
  const Identity known{"\"one\"", "", 10};
  const Outcome middle = read({3, 4}, &known, "HTTP/1.1 200 OK\nContent-Length: 10\n", file);
  CHECK(middle.verdict.kind == Kind::Complete);
  CHECK(middle.bytes == "3456");
  const Outcome first = read({0, 100}, nullptr, "HTTP/1.1 200 OK\nContent-Length: 10\n", file);
  CHECK(first.verdict.kind == Kind::Complete);
  CHECK(first.bytes == file);
  const Outcome short_of = read({3, 4}, &known, "HTTP/1.1 200 OK\n", "01234");
  CHECK(short_of.verdict.kind == Kind::Again);  // it has no length, but we know it
  CHECK(short_of.bytes == "34");
  const Outcome chunked = read({0, 100}, nullptr, "HTTP/1.1 200 OK\n", file);
  CHECK(chunked.verdict.kind == Kind::Complete);
  const Outcome cut = read({0, 100}, nullptr, "HTTP/1.1 200 OK\n", file, true);
  CHECK(cut.verdict.kind == Kind::Again);
}

TEST_CASE("a status says whether to ask again") {
  for (const char* status : {"408", "425", "429", "500", "502", "503", "504"}) {
    CAPTURE(status);
    const Outcome outcome =
        read({0, 5}, nullptr, std::string("HTTP/1.1 ") + status + " Sorry\nRetry-After: 7\n");
    CHECK(outcome.verdict.kind == Kind::Again);
    CHECK(outcome.verdict.retry_after_s == 7u);
  }
  for (const char* status : {"400", "401", "403", "405", "501", "505", "302", "204", "999", "x"}) {
    CAPTURE(status);
    const Outcome outcome =
        read({0, 5}, nullptr, std::string("HTTP/1.1 ") + status + " No\n", "abcde");
    CHECK(outcome.verdict.kind == Kind::Refused);
    CHECK(outcome.verdict.failure.error == Error::ReadFailed);
    CHECK(outcome.bytes.empty());
  }
  for (const char* status : {"404", "410"}) {
    CHECK(read({0, 5}, nullptr, std::string("HTTP/1.1 ") + status + "\n").verdict.failure.error ==
          Error::NotFound);
  }
}

TEST_CASE("only the last header of several counts") {
  const Outcome outcome = read({0, 5}, nullptr,
                               "HTTP/1.1 302 Found\nContent-Length: 99\nETag: \"x\"\n\n"
                               "HTTP/1.1 100 Continue\n\n"
                               "HTTP/1.1 206 Partial Content\nContent-Range: bytes 0-4/5\n",
                               "abcde");
  CHECK(outcome.verdict.kind == Kind::Complete);
  CHECK(outcome.bytes == "abcde");
}

TEST_CASE("an empty file is no failure, and compression is") {
  const Outcome empty =
      read({0, 65536}, nullptr, "HTTP/1.1 416 Range Not Satisfiable\nContent-Range: bytes */0\n");
  CHECK(empty.verdict.kind == Kind::Complete);
  const Outcome packed = read({0, 5}, nullptr,
                              "HTTP/1.1 206 Partial Content\nContent-Range: bytes 0-4/5\n"
                              "Content-Encoding: gzip\n");
  CHECK(packed.verdict.kind == Kind::Refused);
  CHECK(packed.verdict.failure.error == Error::NotSupported);
}

TEST_CASE("If-Range takes a strong ETag, else a date") {
  CHECK(Identity{"\"a\"", "date", 1}.validator() == "\"a\"");
  CHECK(Identity{"W/\"a\"", "date", 1}.validator() == "date");
  CHECK(Identity{"", "", 1}.validator().empty());
}

TEST_CASE("a URL is printed without what may be secret") {
  CHECK(http::printable_url("https://me:word@host:81/a@b.crease?key=1#x") ==
        "https://host:81/a@b.crease");
  CHECK(http::printable_url("http://host") == "http://host");
}

TEST_CASE("what was read makes room first") {
  http::TransferredBytes kept(100);
  kept.put(0, some_bytes(40));
  kept.put(1000, some_bytes(40, 2));
  std::vector<std::byte> into(10);
  CHECK(kept.read(1005, into));
  CHECK(into == part_of(some_bytes(40, 2), {5, 10}));
  CHECK(kept.unread_bytes() == 40);
  kept.put(2000, some_bytes(40, 3));  // the one that was read goes
  CHECK(!kept.has({1000, 1}));
  CHECK(kept.has({0, 40}));
  CHECK(!kept.has({0, 41}));
  CHECK(!kept.has({39, 2}));
  kept.put(3000, some_bytes(40, 4));  // then the oldest
  CHECK(!kept.has({0, 1}));
  kept.put(4000, some_bytes(101, 5));  // more than there is room
  CHECK(!kept.has({4000, 1}));
  CHECK(kept.unread_bytes() == 80);
}

}  // namespace
}  // namespace crease

// What `crease serve` answers.
#include "crease/file_server.h"

#include "serve/file_answer.h"
#include "serve/open_below.h"
#include "stream/fault_host.h"
#include "stream/raw_client.h"
#include "stream/stream_files.h"

#include <nlohmann/json.hpp>

#include <mutex>

#include <fcntl.h>
#include <sys/stat.h>

namespace crease {
namespace {

using serve::answer_for;
using serve::FileAnswer;
using serve::FileFacts;

TEST_CASE("ranges are what RFC 9110 says") {
  const FileFacts file{1000, "\"e\"", "Sun, 06 Nov 1994 08:49:37 GMT"};
  struct Row {
    const char* range;
    int status;
    std::uint64_t offset, bytes;
    const char* content_range;
  };
  const Row rows[] = {
      {"", 200, 0, 1000, ""},
      {"bytes=0-9", 206, 0, 10, "bytes 0-9/1000"},
      {"bytes=990-", 206, 990, 10, "bytes 990-999/1000"},
      {"bytes=990-2000", 206, 990, 10, "bytes 990-999/1000"},
      {"bytes=-10", 206, 990, 10, "bytes 990-999/1000"},
      {"bytes=-2000", 206, 0, 1000, "bytes 0-999/1000"},
      {"bytes=0-99999999999999999999999", 206, 0, 1000, "bytes 0-999/1000"},
      {"bytes=1000-1001", 416, 0, 0, "bytes */1000"},
      {"bytes=99999999999999999999999-", 416, 0, 0, "bytes */1000"},
      {"bytes=-0", 416, 0, 0, "bytes */1000"},
      // To be ignored: no ranges, other units, several.
      {"bytes=9-0", 200, 0, 1000, ""},
      {"bytes=x", 200, 0, 1000, ""},
      {"bytes=-", 200, 0, 1000, ""},
      {"bytes=+1-2", 200, 0, 1000, ""},
      {"lines=0-9", 200, 0, 1000, ""},
      {"bytes=0-1,5-6", 200, 0, 1000, ""},
  };
  for (const Row& row : rows) {
    CAPTURE(row.range);
    const FileAnswer answer = answer_for(file, {.range = row.range});
    CHECK(answer.status == row.status);
    CHECK(answer.offset == row.offset);
    CHECK(answer.bytes == row.bytes);
    CHECK(answer.content_range == row.content_range);
  }
  CHECK(answer_for({0, "", ""}, {.range = "bytes=0-9"}).status == 416);
}

TEST_CASE("conditions are about the same file") {
  const FileFacts file{1000, "\"e\"", "Sun, 06 Nov 1994 08:49:37 GMT"};
  const auto status = [&](const serve::RequestFields& fields) {
    return answer_for(file, fields).status;
  };
  CHECK(status({.range = "bytes=0-9", .if_range = "\"e\""}) == 206);
  CHECK(status({.range = "bytes=0-9", .if_range = "\"f\""}) == 200);
  CHECK(status({.range = "bytes=0-9", .if_range = "W/\"e\""}) == 200);
  CHECK(status({.range = "bytes=0-9", .if_range = "Sun, 06 Nov 1994 08:49:37 GMT"}) == 206);
  CHECK(status({.range = "bytes=0-9", .if_range = "Sun, 06 Nov 1994 08:49:38 GMT"}) == 200);
  CHECK(status({.if_none_match = "\"e\""}) == 304);
  CHECK(status({.if_none_match = "\"a\", W/\"e\""}) == 304);
  CHECK(status({.if_none_match = "*"}) == 304);
  CHECK(status({.if_none_match = "\"a\""}) == 200);
  CHECK(status({.if_modified_since = "Sun, 06 Nov 1994 08:49:37 GMT"}) == 304);
  CHECK(status({.if_none_match = "\"a\"", .if_modified_since = "Sun, 06 Nov 1994 08:49:37 GMT"}) ==
        200);
}

TEST_CASE("a date is written as HTTP wants it") {
  CHECK(serve::http_date(784111777) == "Sun, 06 Nov 1994 08:49:37 GMT");
}

TEST_CASE("paths that lead elsewhere are refused before anything is opened") {
  for (const char* path : {"",
                           "a",
                           "//a",
                           "/a//b",
                           "/..",
                           "/../a",
                           "/a/../b",
                           "/.",
                           "/a/./b",
                           "/%2e%2e/a",
                           "/.%2E/a",
                           "/..%2fa",
                           "/a%2f..%2fb",
                           "/a%5c..%5cb",
                           "/a\\b",
                           "/.hidden",
                           "/a/.git/config",
                           "/a%00b",
                           "/%",
                           "/%4",
                           "/%zz",
                           "http://host/a"}) {
    CAPTURE(path);
    CHECK(!serve::parse_url_path(path));
  }
  CHECK(serve::parse_url_path("/")->names.empty());
  CHECK(serve::parse_url_path("/a%20b/c..crease")->names ==
        std::vector<std::string>{"a b", "c..crease"});
}

struct Served {
  std::vector<std::byte> bytes = some_bytes(300'000);
  TestFolder outside;
  std::filesystem::path folder = outside.path() / "served";
  std::unique_ptr<FileServer> server;

  explicit Served(FileServerOptions options = {}) {
    std::filesystem::create_directories(folder / "sub" / ".git");
    outside.write("secret.crease", "secret");
    outside.write("served/a <b>.crease", bytes);
    outside.write("served/notes.txt", "notes");
    outside.write("served/page.html", "<p>");
    outside.write("served/.hidden.crease", "hidden");
    outside.write("served/sub/.git/config", "hidden");
    outside.write("served/sub/small.crease", "small");
    std::filesystem::create_symlink("../secret.crease", folder / "link.crease");
    std::filesystem::create_directory_symlink("..", folder / "up");
    ::mkfifo((folder / "pipe.crease").c_str(), 0600);
    Result<std::unique_ptr<FileServer>> started = FileServer::start(folder, options);
    REQUIRE(started.ok());
    server = *std::move(started);
  }
};

const std::string kModel = "/a%20%3Cb%3E.crease";

TEST_CASE("files and parts of them are served over one connection") {
  const Served served;
  RawClient client(served.server->port());
  const RawAnswer whole = client.get(kModel);
  CHECK(whole.status == 200);
  CHECK(whole.body == text_of(served.bytes));
  CHECK(whole.field("Content-Type") == "application/octet-stream");
  CHECK(whole.field("Accept-Ranges") == "bytes");
  CHECK(whole.field("Access-Control-Allow-Origin") == "*");
  for (const char* field : {"Content-Range", "ETag", "Accept-Ranges"}) {
    CHECK(whole.field("Access-Control-Expose-Headers").find(field) != std::string::npos);
  }
  const RawAnswer part =
      client.get(kModel, "Range: bytes=1000-1999\r\nIf-Range: " + whole.field("ETag") + "\r\n");
  CHECK(part.status == 206);
  CHECK(part.field("Content-Range") == "bytes 1000-1999/300000");
  CHECK(part.body == text_of(part_of(served.bytes, {1000, 1000})));
  CHECK(part.field("ETag") == whole.field("ETag"));
  const RawAnswer beyond = client.get(kModel, "Range: bytes=300000-\r\n");
  CHECK(beyond.status == 416);
  CHECK(beyond.field("Content-Range") == "bytes */300000");
  const RawAnswer head = client.get(kModel, {}, "HEAD");
  CHECK(head.status == 200);
  CHECK(head.field("Content-Length") == "300000");
  CHECK(client.get(kModel, "If-None-Match: " + whole.field("ETag") + "\r\n").status == 304);
  CHECK(client.get("/notes.txt").body == "notes");
}

TEST_CASE("an ETag belongs to one content") {
  const Served served;
  RawClient client(served.server->port());
  const std::string etag = client.get(kModel).field("ETag");
  CHECK(etag.starts_with('"'));
  served.outside.write("served/new", some_bytes(300'000, 2));
  std::filesystem::rename(served.folder / "new", served.folder / "a <b>.crease");
  CHECK(client.get(kModel).field("ETag") != etag);
}

TEST_CASE("browsers elsewhere may ask for ranges") {
  const Served served;
  RawClient client(served.server->port());
  const RawAnswer answer = client.get(
      kModel, "Origin: http://elsewhere\r\nAccess-Control-Request-Headers: range\r\n", "OPTIONS");
  CHECK(answer.status == 204);
  CHECK(answer.field("Access-Control-Allow-Origin") == "*");
  CHECK(answer.field("Access-Control-Allow-Headers").find("Range") != std::string::npos);
  for (const char* method : {"POST", "PUT", "DELETE", "TRACE", "X"}) {
    CAPTURE(method);
    RawClient other(served.server->port());
    CHECK(other.get(kModel, "Content-Length: 0\r\n", method).status == 405);
  }
}

TEST_CASE("nothing but the folder's files is served") {
  const Served served;
  for (const char* path : {"/../secret.crease", "/%2e%2e/secret.crease", "/sub/../../secret.crease",
                           "/..%2fsecret.crease", "/link.crease", "/up/secret.crease", "/up/",
                           "/.hidden.crease", "/sub/.git/config", "/none.crease", "/pipe.crease",
                           "/notes.txt/", "//notes.txt", "/sub/small.crease/x"}) {
    CAPTURE(path);
    RawClient client(served.server->port());
    const RawAnswer answer = client.get(path);
    CHECK(answer.status >= 400);
    CHECK(answer.status < 500);
    CHECK(answer.body.find("secret") == std::string::npos);
    CHECK(answer.body.find("hidden") == std::string::npos);
  }
  const std::string absolute =
      "GET " + (served.outside.path() / "secret.crease").string() + " HTTP/1.1\r\nHost: x\r\n\r\n";
  CHECK(RawClient(served.server->port()).ask(absolute).status == 404);
}

TEST_CASE("symbolic links are followed when that was asked for") {
  const Served served({.follow_symlinks = true});
  RawClient client(served.server->port());
  CHECK(client.get("/link.crease").body == "secret");
  CHECK(client.get("/up/secret.crease").body == "secret");
  CHECK(client.get("/../secret.crease").status == 404);
}

TEST_CASE("a folder lists its models and folders") {
  const Served served;
  RawClient client(served.server->port());
  const RawAnswer json = client.get("/?json");
  CHECK(json.field("Content-Type") == "application/json");
  const auto list = nlohmann::json::parse(json.body);
  CHECK(list["folder"] == "/");
  REQUIRE(list["files"].size() == 1);
  CHECK(list["files"][0]["name"] == "a <b>.crease");
  CHECK(list["files"][0]["bytes"] == 300'000);
  CHECK("/" + list["files"][0]["url"].get<std::string>() == kModel);
  REQUIRE(list["folders"].size() == 1);
  CHECK(list["folders"][0]["url"] == "sub/");

  const RawAnswer page = client.get("/");
  CHECK(page.field("Content-Type") == "text/html; charset=utf-8");
  CHECK(page.body.find("href=\"a%20%3Cb%3E.crease\">a &lt;b&gt;.crease<") != std::string::npos);
  const RawAnswer moved = client.get("/sub");
  CHECK(moved.status == 301);
  CHECK(moved.field("Location") == "/sub/");
  served.outside.write("served/sub/index.html", "<b>here</b>");
  CHECK(client.get("/sub/").body == "<b>here</b>");
  CHECK(nlohmann::json::parse(client.get("/sub/?json").body)["files"].size() == 1);
}

TEST_CASE("types are known by name") {
  const Served served;
  RawClient client(served.server->port());
  CHECK(client.get("/page.html").field("Content-Type") == "text/html; charset=utf-8");
  for (const auto& [name, type] : {std::pair("v.wasm", "application/wasm"),
                                   {"v.js", "text/javascript; charset=utf-8"},
                                   {"v.glb", "model/gltf-binary"}}) {
    served.outside.write(std::string("served/") + name, "x");
    CHECK(client.get(std::string("/") + name).field("Content-Type") == type);
  }
}

TEST_CASE("a file of 5 GB is served from anywhere") {
  const Served served;
  const std::filesystem::path large = served.outside.write("served/large.crease", "begin");
  constexpr std::uint64_t kSize = 5'000'000'000;
  std::filesystem::resize_file(large, kSize);  // takes no room
  {
    std::fstream out(large, std::ios::binary | std::ios::in | std::ios::out);
    out.seekp(4'500'000'000);
    out << "here";
  }
  RawClient client(served.server->port());
  const RawAnswer part = client.get("/large.crease", "Range: bytes=4500000000-4500000003\r\n");
  CHECK(part.body == "here");
  CHECK(part.field("Content-Range") == "bytes 4500000000-4500000003/5000000000");
  const Result<ByteSourcePtr> source =
      open_http_source(served.server->url() + "large.crease", hasty());
  REQUIRE(source.ok());
  CHECK((*source)->size() == kSize);
  CHECK(text_of(read_all(**source, {4'500'000'000, 4})) == "here");
}

TEST_CASE("each request is told") {
  std::mutex lock;
  std::vector<ServedRequest> told;
  const Served served({.on_request = [&](const ServedRequest& request) {
    const std::lock_guard guard(lock);
    told.push_back(request);
  }});
  RawClient client(served.server->port());
  client.get(kModel, "Range: bytes=5-9\r\n");
  const std::lock_guard guard(lock);
  REQUIRE(told.size() == 1);
  CHECK(told[0].method == "GET");
  CHECK(told[0].path == kModel);
  CHECK(told[0].range == "bytes=5-9");
  CHECK(told[0].status == 206);
  CHECK(told[0].bytes == 5);
}

TEST_CASE("a slow line gives the same bytes, and goes when it should") {
  const Served served({.bytes_per_second = 20e6, .delay = std::chrono::milliseconds(1)});
  RawClient client(served.server->port());
  CHECK(client.get(kModel).body == text_of(served.bytes));
  CHECK(client.get(kModel, "Range: bytes=1000-1999\r\n").body ==
        text_of(part_of(served.bytes, {1000, 1000})));

  // An answer that would take a day is under way when the server goes.
  Served slow({.bytes_per_second = 1});
  const AsyncSourcePtr source = open_async_http(slow.server->url() + kModel.substr(1), hasty());
  source->request(FileRange{0, 10});
  slow.server.reset();
}

TEST_CASE("a folder that is not there, and a port that is taken") {
  const TestFolder folder;
  const auto none = FileServer::start(folder.path() / "none");
  REQUIRE(!none.ok());
  CHECK(none.failure().error == Error::NotFound);
  const auto file = FileServer::start(folder.write("file", "x"));
  REQUIRE(!file.ok());
  const auto first = FileServer::start(folder.path());
  REQUIRE(first.ok());
  CHECK((*first)->url() == "http://127.0.0.1:" + std::to_string((*first)->port()) + "/");
  const auto second = FileServer::start(folder.path(), {.port = (*first)->port()});
  REQUIRE(!second.ok());
  CHECK(second.failure().message.find("127.0.0.1 port ") == 0);
}

}  // namespace
}  // namespace crease

// A real host, as docs/hosting.md configures it.
#include "stream/nginx_host.h"
#include "stream/raw_client.h"

namespace crease {
namespace {

TEST_CASE("nginx as documented serves models, over HTTP/1.1 and HTTP/2") {
  const NginxHost host;
  host.root().write("city.crease", city_bytes());
  const Result<BlockFile> local = BlockFile::open(memory_source(city_bytes()));
  const Result<DecodedModel> expected = decode_model(*local);
  HttpOptions options = hasty();
  options.ca_file = host.ca_file();
  for (const bool has_tls : {false, true}) {
    CAPTURE(has_tls);
    const std::size_t before = host.log().size();
    const std::string url = has_tls ? host.tls_url("city.crease") : host.url("city.crease");
    const Result<ByteSourcePtr> source = open_http_source(url, options);
    REQUIRE_MESSAGE(source.ok(), (source.ok() ? "" : source.failure().message));
    const Result<BlockFile> file = BlockFile::open(*source);
    REQUIRE(file.ok());
    const Result<DecodedModel> model = decode_model(*file);
    REQUIRE(model.ok());
    CHECK(model->mesh.positions == expected->mesh.positions);
    CHECK(model->mesh.triangles == expected->mesh.triangles);
    const std::vector<std::string> log = host.log();
    CHECK(log.size() > before + 1);
    CHECK(log.size() <= before + 2 + file->facts().bands.size());
    for (std::size_t i = before; i < log.size(); ++i) {
      CHECK(log[i].starts_with(has_tls ? "HTTP/2.0 206 bytes=" : "HTTP/1.1 206 bytes="));
    }
  }
}

TEST_CASE("a certificate of nobody we know is refused at once") {
  const NginxHost host;
  host.root().write("a.crease", "x");
  const Result<ByteSourcePtr> source = open_http_source(host.tls_url("a.crease"), hasty());
  REQUIRE(!source.ok());
  CHECK(source.failure().error == Error::ReadFailed);
  CHECK(source.failure().message.find("certificate") != std::string::npos);
  CHECK(source.failure().message.find("attempts") == std::string::npos);
}

TEST_CASE("what nginx as documented answers") {
  const NginxHost host;
  const std::vector<std::byte> bytes = some_bytes(10'000);
  host.root().write("a.crease", bytes);
  host.root().write(".hidden.crease", "hidden");
  host.root().write("other.txt", std::string(10'000, 'x'));
  std::filesystem::create_symlink("a.crease", host.root().path() / "link.crease");
  RawClient client(host.port());
  const std::string kGzip = "Accept-Encoding: gzip\r\n";
  const RawAnswer whole = client.get("/a.crease", kGzip);
  CHECK(whole.status == 200);
  CHECK(whole.field("Content-Encoding").empty());
  CHECK(whole.field("Content-Type") == "application/octet-stream");
  CHECK(whole.field("ETag").starts_with('"'));
  CHECK(whole.field("Access-Control-Allow-Origin") == "*");
  CHECK(whole.field("Access-Control-Expose-Headers").find("Content-Range") != std::string::npos);
  CHECK(whole.field("Cache-Control") == "public, max-age=3600");
  CHECK(client.get("/a.crease", kGzip + "Range: bytes=10-19\r\n").field("Content-Range") ==
        "bytes 10-19/10000");
  CHECK(client.get("/a.crease", "Range: bytes=0-1,5-6\r\n").status == 200);
  const RawAnswer beyond = client.get("/a.crease", "Range: bytes=10000-\r\n");
  CHECK(beyond.status == 416);
  CHECK(beyond.field("Access-Control-Allow-Origin") == "*");
  const RawAnswer asked = client.get("/a.crease", "Origin: http://elsewhere\r\n", "OPTIONS");
  CHECK(asked.status == 204);
  CHECK(asked.field("Access-Control-Allow-Headers").find("Range") != std::string::npos);
  CHECK(client.get("/.hidden.crease").status == 404);
  CHECK(client.get("/link.crease").status >= 400);
  // The rest of the configuration does compress, so the above says something.
  CHECK(RawClient(host.port()).get("/other.txt", kGzip).field("Content-Encoding") == "gzip");
}

TEST_CASE("a file that is replaced under way is noticed behind nginx") {
  const NginxHost host;
  host.root().write("a.crease", some_bytes(300'000));
  const Result<ByteSourcePtr> source = open_http_source(host.url("a.crease"), hasty());
  REQUIRE(source.ok());
  host.root().write("new", some_bytes(300'001, 2));
  std::filesystem::rename(host.root().path() / "new", host.root().path() / "a.crease");
  std::vector<std::byte> into(10);
  const Status status = (*source)->read(200'000, into);
  REQUIRE(!status.ok());
  CHECK(status.failure().error == Error::Replaced);
}

}  // namespace
}  // namespace crease

// Flights over hosts that fail in every way: in each frame what is shown is right, and once the
// host answers as it should all of it comes.
#include "crease/block_streamer.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/block_vertices_oracle.h"
#include "runtime/shown_surface.h"
#include "stream/fault_host.h"
#include "stream/stream_files.h"
#include "support/sanitized.h"

#include <cmath>

namespace crease {
namespace {

// A closed city in many blocks, most of them behind the first 64 KiB.
std::vector<std::byte> city_in_blocks(std::uint32_t seed) {
  BuildOptions options;
  options.simplify.patch_triangles = 800;
  Result<Built> built = build_model(generate_city({.seed = seed, .triangles = 32'000}), options);
  REQUIRE(built.ok());
  REQUIRE(built->file_bytes.size() > std::size_t(80) << 10);
  return std::move(built->file_bytes);
}

const std::vector<std::byte>& one_city() {
  static const std::vector<std::byte> bytes = city_in_blocks(1);
  return bytes;
}

// Many small requests, so that many can fail.
HttpOptions in_small_parts() {
  HttpOptions options = hasty();
  options.async.max_gap_bytes = 0;
  options.async.min_request_bytes = 1024;
  options.async.max_request_bytes = 4096;
  options.low_speed_seconds = 1;
  options.low_speed_bytes = 1'000'000;
  return options;
}

constexpr std::uint32_t kFaultKinds = 11;

// Wrong in the way that `kind` says.
HostReply faulty_reply(const HostRequest& request, std::span<const std::byte> file,
                       std::uint32_t kind, std::mt19937& random) {
  HostReply good = good_reply(request, file);
  const std::size_t body = good.bytes.find("\r\n\r\n") + 4;
  switch (kind) {
    case 0:
      return {"", HostReply::Close};
    case 1:  // broken in the middle
      good.bytes.resize(body + random() % (good.bytes.size() - body));
      return {good.bytes, HostReply::Close};
    case 2:
      good.bytes[body + random() % (good.bytes.size() - body)] ^= 16;
      return good;
    case 3:
      return reply("503 Busy", "Retry-After: 0\r\n", "sorry");
    case 4:
      return reply("500 Oops", "", "sorry");
    case 5:
      return reply(
          "206 Partial Content",
          "ETag: \"one\"\r\nContent-Range: bytes 0-9/" + std::to_string(file.size()) + "\r\n",
          "0123456789");
    case 6:  // the whole file for a part
      return reply("200 OK", "ETag: \"one\"\r\n", text_of(file));
    case 7:
      return {"What would you like?\r\n\r\n", HostReply::Close};
    case 8:
      return reply("404 Not Found", "", "no");
    case 9: {  // other bytes than it says
      const FileRange range = *request.range();
      HostRequest other = request;
      other.head =
          "GET / HTTP/1.1\r\nRange: bytes=0-" + std::to_string(range.bytes - 1) + "\r\n\r\n";
      const HostReply start = good_reply(other, file);
      const std::size_t from = start.bytes.find("\r\n\r\n") + 4;
      good.bytes.replace(body, std::string::npos, start.bytes.substr(from));
      return good;
    }
    default:  // one that comes late, so that others overtake it
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 8));
      return good;
  }
}

// Every third answer is wrong, and one of them never ends.
class UnsteadyHost {
 public:
  UnsteadyHost(std::span<const std::byte> file, std::uint32_t seed)
      : file_(file), seed_(seed), host_([this](const HostRequest& r) { return answer(r); }) {}

  FaultHost& host() { return host_; }
  void get_well() { is_well_ = true; }
  std::size_t faults() const { return faults_; }

 private:
  HostReply answer(const HostRequest& request) {
    if (is_well_ || request.number == 0) return good_reply(request, file_);
    std::mt19937 random(seed_ * 1000 + std::uint32_t(request.number));
    if (random() % 3 != 0) return good_reply(request, file_);
    ++faults_;
    if (!has_trickled_.exchange(true)) {
      HostReply slow = good_reply(request, file_);
      slow.bytes.resize(slow.bytes.size() - 100);
      slow.then = HostReply::Hang;
      return slow;
    }
    return faulty_reply(request, file_, std::uint32_t(random() % kFaultKinds), random);
  }

  const std::span<const std::byte> file_;
  const std::uint32_t seed_;
  std::atomic<bool> is_well_{false}, has_trickled_{false};
  std::atomic<std::size_t> faults_{0};
  FaultHost host_;  // the last one: its threads end before what they use
};

// Each frame is drawn by a check, which takes far longer than the frame does.
bool is_checked(int frame) {
  return !kSanitized || frame % 4 == 3;
}

class Flight {
 public:
  explicit Flight(const BlockFile& file) : file_(file), checksums_(*drawn_checksums(file)) {
    const Result<DecodedModel> base = decode_model(file, {.contracted_bands = 0});
    REQUIRE(base.ok());
    triangles_ = base->mesh.triangle_count();
    for (const Vec3d& p : base->mesh.positions) reach_ = std::max(reach_, length(p));
  }

  // Low over the city, each frame in another mode than the one before.
  BlockViewParameters view(int frame) const {
    BlockViewParameters parameters;
    const double a = 0.2 * frame;
    Camera& camera = parameters.view.camera;
    camera.position = Vec3d{std::cos(a), std::sin(a), 0.2} * (0.4 * reach_);
    camera.target = Vec3d{std::cos(a + 1), std::sin(a + 1), 0} * (0.3 * reach_);
    camera.pixels = 1;
    parameters.in_levels = frame / 8 % 3 != 0;
    parameters.by_vertex = frame / 8 % 3 == 2;
    parameters.max_bytes = frame / 24 % 2 ? 3'000'000 : std::size_t(1) << 30;
    return parameters;
  }

  void check(const BlockStreamer& streamer, const BlockViewParameters& parameters,
             bool in_depth) const {
    const BlockMesh& mesh = streamer.mesh();
    CHECK(wrong_blocks(mesh, checksums_) == 0);
    CHECK(open_edges(mesh) == 0);
    if (!parameters.by_vertex) CHECK(mesh.resident_bytes() <= parameters.max_bytes);
    if (!in_depth || mesh.shown().empty()) return;
    if (parameters.in_levels) {
      check_by_vertex(mesh);
    } else {
      check_shown(file_, mesh, refined_blocks(file_, mesh));
    }
  }

  void finish(BlockStreamer& streamer) const {
    BlockViewParameters parameters = view_of_all();
    for (int frames = 0; !streamer.update(parameters).is_complete; ++frames) {
      REQUIRE(frames < 100'000);
      streamer.wait(std::chrono::milliseconds(20));
    }
    check(streamer, parameters, true);
    CHECK(streamer.mesh().triangle_count() == triangles_);
    CHECK(streamer.mesh().error().surface == 0);
    CHECK(!streamer.trouble());
  }

 private:
  const BlockFile& file_;
  std::vector<std::uint64_t> checksums_;
  std::size_t triangles_ = 0;
  double reach_ = 0;
};

BlockStreamer streamer_of(const std::string& url) {
  Result<BlockStreamer> streamer = BlockStreamer::open(
      open_async_http(url, in_small_parts()),
      {.max_pending_bytes = 20'000, .first_pause = std::chrono::milliseconds(1)});
  REQUIRE_MESSAGE(streamer.ok(), (streamer.ok() ? "" : streamer.failure().message));
  return *std::move(streamer);
}

TEST_CASE("whatever a host does along a flight, what is shown is right, and in the end all of it") {
  const Result<BlockFile> file = BlockFile::open(memory_source(one_city()));
  REQUIRE(file.ok());
  const Flight flight(*file);
  for (std::uint32_t seed = 1; seed <= (kSanitized ? 1 : 3); ++seed) {
    CAPTURE(seed);
    UnsteadyHost unsteady(one_city(), seed);
    BlockStreamer streamer = streamer_of(unsteady.host().url());
    for (int frame = 0; frame < 96; ++frame) {
      const BlockViewParameters parameters = flight.view(frame);
      if (frame == 40) unsteady.host().shut();
      if (frame == 48) {
        // It is shut until that is noticed, however slow threads are beside the frames.
        for (int i = 0; i < 5000 && streamer.statistics().blocks_failed == 0; ++i) {
          streamer.update(parameters);
          streamer.wait(std::chrono::milliseconds(4));
        }
        unsteady.host().open_again();
      }
      streamer.update(parameters);
      if (is_checked(frame)) flight.check(streamer, parameters, frame % (kSanitized ? 24 : 6) == 3);
      streamer.wait(std::chrono::milliseconds(4));
    }
    CHECK(unsteady.faults() > 5);
    CHECK(streamer.statistics().blocks_failed > 0);
    unsteady.get_well();
    flight.finish(streamer);
  }
}

TEST_CASE(
    "a file that is replaced along a flight stays as it was, and is there when opened again") {
  const std::vector<std::byte> other = city_in_blocks(2);
  const Result<BlockFile> file = BlockFile::open(memory_source(one_city()));
  const Result<BlockFile> other_file = BlockFile::open(memory_source(other));
  REQUIRE((file.ok() && other_file.ok()));
  const Flight flight(*file);
  std::vector<std::byte> as_large = other;  // as a host that tells no version would serve it
  as_large.resize(one_city().size());
  for (const bool tells_version : {true, false}) {
    CAPTURE(tells_version);
    std::atomic<bool> is_replaced{false};
    // The second half comes only then: slow frames would have all of the file before.
    const auto wait_for_second_half = [&](const HostRequest& request) {
      const std::optional<FileRange> range = request.range();
      if (!range || range->offset < one_city().size() / 2) return;
      for (int i = 0; i < 10'000 && !is_replaced; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    };
    FaultHost host([&](const HostRequest& request) {
      wait_for_second_half(request);
      if (tells_version) {
        return is_replaced ? good_reply(request, other, "\"two\"")
                           : good_reply(request, one_city());
      }
      HostReply reply = good_reply(request, is_replaced ? as_large : one_city());
      reply.bytes.erase(reply.bytes.find("ETag: "), std::string("ETag: \"one\"\r\n").size());
      return reply;
    });
    BlockStreamer streamer = streamer_of(host.url());
    for (int frame = 0; frame < 8; ++frame) {
      streamer.update(flight.view(frame));
      streamer.wait(std::chrono::milliseconds(4));
    }
    is_replaced = true;
    for (int frame = 0; frame < 30 || !streamer.trouble(); ++frame) {
      REQUIRE(frame < 100'000);
      CHECK(!streamer.update(view_of_all()).is_complete);
      if (is_checked(frame)) flight.check(streamer, view_of_all(), frame % 8 == 7 && frame < 30);
      streamer.wait(std::chrono::milliseconds(4));
    }
    CHECK(streamer.trouble()->error == (tells_version ? Error::Replaced : Error::BadChecksum));
    CHECK(streamer.mesh().triangle_count() > 0);
    if (!tells_version) continue;
    BlockStreamer again = streamer_of(host.url());
    Flight(*other_file).finish(again);
  }
}

}  // namespace
}  // namespace crease

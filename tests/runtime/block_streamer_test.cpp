// A mesh that streams: whatever the source does, what is shown is a cut of blocks that are right,
// and in the end all that the view wants.
#include "crease/block_streamer.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/block_vertices_oracle.h"
#include "runtime/faulty_source.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <deque>
#include <limits>
#include <map>
#include <random>

namespace crease {
namespace {

// Answers late, in any order, wrongly, or not at all but with a failure.
class UnsteadySource : public AsyncSource {
 public:
  UnsteadySource(std::span<const std::byte> bytes, std::uint64_t seed, int failures_of_ten)
      : bytes_(bytes), random_(seed), failures_of_ten_(failures_of_ten) {}

  std::string name() const override { return "unsteady"; }
  std::optional<std::uint64_t> size() const override { return bytes_.size(); }

  Ticket request(std::span<const RangeRequest> ranges) override {
    const Ticket first{next_};
    for (const RangeRequest& r : ranges) waiting_[Ticket{next_++}] = r.range;
    return first;
  }
  void give_back(std::uint64_t, std::vector<std::byte>) override {}
  void cancel(Ticket ticket) override { cancelled_ += waiting_.erase(ticket); }
  void prioritize(Ticket, float) override {}

  std::vector<AsyncAnswer> poll() override {
    std::vector<AsyncAnswer> answers;
    for (auto at = waiting_.begin(); at != waiting_.end();) {
      if (random_() % 3 != 0) {
        ++at;
        continue;
      }
      answers.push_back({at->first, answer(at->second)});
      at = waiting_.erase(at);
    }
    std::shuffle(answers.begin(), answers.end(), random_);
    return answers;
  }
  bool wait(std::chrono::milliseconds) override { return !waiting_.empty(); }
  AsyncStatistics statistics() const override { return {.cancelled = cancelled_}; }

  void set_failures(int of_ten) { failures_of_ten_ = of_ten; }

 private:
  Result<std::vector<std::byte>> answer(const FileRange& range) {
    const auto part = bytes_.subspan(range.offset, range.bytes);
    std::vector<std::byte> bytes(part.begin(), part.end());
    if (int(random_() % 10) >= failures_of_ten_) return bytes;
    if (random_() % 2) return fail(Error::ReadFailed, "unsteady: broke");
    if (!bytes.empty()) bytes[random_() % bytes.size()] ^= std::byte{64};
    return bytes;
  }

  std::span<const std::byte> bytes_;
  std::mt19937_64 random_;
  int failures_of_ten_;
  std::uint64_t next_ = 1, cancelled_ = 0;
  std::map<Ticket, FileRange> waiting_;
};

BlockStreamer opened_streamer(const BlockFile& file, AsyncSourcePtr source,
                              const StreamOptions& options) {
  Result<BlockStreamer> streamer = BlockStreamer::open(file, std::move(source), options);
  REQUIRE(streamer.ok());
  return *std::move(streamer);
}

void finish(BlockStreamer& streamer, const BlockViewParameters& parameters) {
  for (int frames = 0; !streamer.update(parameters).is_complete; ++frames) {
    REQUIRE(frames < 100'000);
    streamer.wait(std::chrono::milliseconds(50));
  }
}

StreamOptions hasty(int threads) {
  return {.decode_threads = threads,
          .max_pending_bytes = 4096,
          .prefetch_frames = 3,
          .first_pause = std::chrono::milliseconds(1)};
}

TEST_CASE("a view is complete in the end, whatever the source does on the way" *
          doctest::test_suite("threads")) {
  std::uint64_t seed = 0;
  for (const ZooMesh& zoo : mesh_zoo()) {
    if (zoo.mesh.vertex_count() == 0) continue;
    INFO(zoo.name);
    const EncodedCase c = simplified_case(zoo.mesh, 100, 14, kCoarsePrecision);
    const BlockFile file = opened(c.bytes);
    std::mt19937_64 random(++seed);
    for (const int threads : {0, 1, 3}) {
      const auto source = std::make_shared<UnsteadySource>(c.bytes, seed, threads);
      BlockStreamer streamer = opened_streamer(file, source, hasty(threads));
      for (int v = 0; v < (kSanitized ? 1 : 3); ++v) {
        const BlockViewParameters parameters = random_view(c.mesh, random);
        for (int frame = 0; frame < 4; ++frame) {
          streamer.update(parameters);
          const BlockSet refined = refined_blocks(file, streamer.mesh());
          if (!refined.empty()) check_shown(file, streamer.mesh(), refined);
        }
        finish(streamer, parameters);
        CHECK((refined_blocks(file, streamer.mesh()) == wanted_blocks(file, parameters.view)));
      }
      CHECK((threads > 0 || !streamer.trouble()));
    }
  }
}

TEST_CASE("by vertex, hierarchies are made beside the frames, and shared by views" *
          doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(smooth_sphere(40, 60), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  std::mt19937_64 random(8);
  for (const int threads : {0, 1, 3}) {
    const auto source = std::make_shared<UnsteadySource>(c.bytes, 5, threads);
    BlockStreamer streamer = opened_streamer(file, source, hasty(threads));
    streamer.set_view_count(2);
    for (int round = 0; round < (kSanitized ? 2 : 6); ++round) {
      BlockViewParameters of[] = {random_view(c.mesh, random), random_view(c.mesh, random)};
      of[0].by_vertex = of[1].by_vertex = round % 3 != 2;
      of[1].max_bytes = round % 2 ? 400'000 : of[1].max_bytes;
      const auto update_both = [&](int& frames) {
        bool is_complete = true;
        for (std::size_t v = 0; v < 2; ++v) is_complete &= streamer.update(of[v], v).is_complete;
        streamer.wait(std::chrono::milliseconds(50));
        return is_complete || ++frames == 3000;  // a budget may keep blocks coming and going
      };
      for (int frames = 0; !update_both(frames);) {
        if (frames > 4) continue;
        for (std::size_t v = 0; v < 2; ++v) check_by_vertex(streamer.mesh(v));
      }
      for (std::size_t v = 0; v < 2; ++v) check_by_vertex(streamer.mesh(v));
      CHECK(streamer.mesh(0).shown_cuts().empty() == (round % 3 == 2));
    }
  }
}

TEST_CASE("an asynchronous source is all that it takes to open a model" *
          doctest::test_suite("threads")) {
  const EncodedCase c = small_case();
  Result<BlockStreamer> streamer = BlockStreamer::open(async_memory_source(c.bytes), hasty(1));
  REQUIRE(streamer.ok());
  CHECK(streamer->head().file_bytes == c.bytes.size());
  finish(*streamer, view_of_all());
  CHECK(streamer->mesh().error().surface == 0);
  const Result<BlockStreamer> broken =
      BlockStreamer::open(async_memory_source(std::span(c.bytes).first(40), "cut"), hasty(1));
  REQUIRE(!broken.ok());
  CHECK(broken.failure().message.find("cut") != std::string::npos);
  CHECK(!BlockStreamer::open(std::make_shared<UnsteadySource>(c.bytes, 1, 10), hasty(1)).ok());
}

TEST_CASE("two views of one model are both complete, and share what both have" *
          doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  std::mt19937_64 random(4);
  for (const int failures : {0, 3}) {
    const auto source = std::make_shared<UnsteadySource>(c.bytes, 11, failures);
    BlockStreamer streamer = opened_streamer(file, source, hasty(1));
    finish(streamer, random_view(c.mesh, random));
    streamer.set_view_count(2);
    REQUIRE(streamer.view_count() == 2);
    for (int round = 0; round < 4; ++round) {
      const BlockViewParameters of[] = {random_view(c.mesh, random), random_view(c.mesh, random)};
      bool is_complete = false;
      for (int frames = 0; !is_complete; ++frames) {
        REQUIRE(frames < 100'000);
        is_complete = true;
        for (std::size_t v = 0; v < 2; ++v) is_complete &= streamer.update(of[v], v).is_complete;
        streamer.wait(std::chrono::milliseconds(50));
      }
      for (std::size_t v = 0; v < 2; ++v) {
        const BlockSet refined = refined_blocks(file, streamer.mesh(v));
        CHECK((refined == wanted_blocks(file, of[v].view)));
        check_shown(file, streamer.mesh(v), refined);
      }
      if (failures > 0) continue;
      std::size_t resident_somewhere = 0;
      for (std::uint32_t b = 0; b < file.block_count(); ++b) {
        const ResidentBlockPtr one = streamer.mesh(0).resident(BlockId{b});
        const ResidentBlockPtr other = streamer.mesh(1).resident(BlockId{b});
        if (one && other) CHECK(one == other);
        resident_somewhere += one || other;
      }
      CHECK(streamer.statistics().blocks_decoded == resident_somewhere);  // none of them twice
    }
    streamer.set_view_count(1);
    const BlockViewParameters last = random_view(c.mesh, random);
    finish(streamer, last);
    CHECK((refined_blocks(file, streamer.mesh()) == wanted_blocks(file, last.view)));
  }
}

TEST_CASE("while the source fails what is shown stays, and says what is wrong" *
          doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(smooth_sphere(40, 60), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  const auto source = std::make_shared<UnsteadySource>(c.bytes, 3, 0);
  BlockStreamer streamer = opened_streamer(file, source, hasty(1));
  BlockViewParameters coarse = view_of_all(), fine = view_of_all();
  coarse.in_levels = fine.in_levels = false;
  coarse.view.max_triangles = c.mesh.triangle_count() / 4;
  finish(streamer, coarse);
  const std::size_t triangles = streamer.mesh().triangle_count();
  CHECK(triangles > 0);
  source->set_failures(10);
  for (int frame = 0; frame < 50; ++frame) {
    CHECK(!streamer.update(fine).is_complete);
    streamer.wait(std::chrono::milliseconds(2));
  }
  CHECK(streamer.mesh().triangle_count() == triangles);
  REQUIRE(streamer.trouble().has_value());
  CHECK(!streamer.trouble()->message.empty());
  CHECK(streamer.statistics().blocks_failed > 0);
  source->set_failures(0);
  finish(streamer, fine);
  CHECK(streamer.mesh().triangle_count() == c.mesh.triangle_count());
  CHECK(!streamer.trouble().has_value());
}

TEST_CASE("what is asked for at once is bounded, and cancelled when nobody wants it" *
          doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 100, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  const auto source = std::make_shared<UnsteadySource>(c.bytes, 5, 0);
  const StreamOptions options = hasty(1);
  BlockStreamer streamer = opened_streamer(file, source, options);
  std::mt19937_64 random(1);
  BlockViewParameters last = view_of_all();
  // What is still asked for when the view changes is up to the decoding thread. Not all blocks fit,
  // so that there is always something to ask for.
  for (int frame = 0; frame < 300 || streamer.statistics().source.cancelled == 0; ++frame) {
    REQUIRE(frame < 100'000);
    if (frame % 5 == 0) last = random_view(c.mesh, random);
    last.max_bytes = 300'000;
    streamer.update(last);
    const StreamStatistics statistics = streamer.statistics();
    CHECK(statistics.pending_bytes <= options.max_pending_bytes);
  }
  last.max_bytes = std::numeric_limits<std::size_t>::max();
  finish(streamer, last);
  CHECK((refined_blocks(file, streamer.mesh()) == wanted_blocks(file, last.view)));
}

TEST_CASE("the names of parts come once the view has what it wants" *
          doctest::test_suite("threads")) {
  for (const ZooMesh& zoo : mesh_zoo()) {
    if (zoo.mesh.parts.empty()) continue;
    INFO(zoo.name);
    const EncodedCase c = simplified_case(zoo.mesh, 100, 14, kCoarsePrecision);
    const BlockFile file = opened(c.bytes);
    const auto source = std::make_shared<UnsteadySource>(c.bytes, 7, 5);
    BlockStreamer streamer = opened_streamer(file, source, hasty(1));
    BlockViewParameters parameters = view_of_all();
    finish(streamer, parameters);
    for (int frame = 0; streamer.mesh().extract().parts != c.mesh.parts; ++frame) {
      REQUIRE(frame < 10'000);
      streamer.update(parameters);
      streamer.wait(std::chrono::milliseconds(1));
    }
  }
}

TEST_CASE("a camera that moves on finds what it will want" * doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(kSanitized ? smooth_sphere(50, 80) : smooth_sphere(80, 120),
                                        300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  for (const bool prefetches : {false, true}) {
    StreamOptions options = hasty(0);
    options.max_pending_bytes = 1 << 20;
    options.prefetch_frames = prefetches ? 60 : 0;
    BlockStreamer streamer = opened_streamer(file, async_memory_source(c.bytes), options);
    BlockViewParameters parameters = view_of_all();
    parameters.view.camera.pixels = 1;
    parameters.view.camera.target = {0, 0, 0};
    for (int frame = 0; frame < 400; ++frame) {
      parameters.view.camera.position = {0.05 * frame - 20, 1.5, 0};
      streamer.update(parameters);
    }
    CHECK((streamer.statistics().blocks_prefetched > 0) == prefetches);
  }
}

TEST_CASE("memory stays within the budget along a flight" * doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(kSanitized ? smooth_sphere(50, 80) : smooth_sphere(80, 120),
                                        300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  for (const bool in_levels : {false, true}) {
    BlockStreamer streamer = opened_streamer(file, async_memory_source(c.bytes), hasty(1));
    BlockViewParameters parameters = view_of_all();
    finish(streamer, parameters);
    const std::size_t all = streamer.mesh().resident_bytes();
    parameters.max_bytes = all / 3;
    parameters.in_levels = in_levels;
    parameters.view.coarse_outside = true;
    parameters.view.camera.pixels = 0.25;
    std::size_t dropped = 0, lists = 0;
    const int frames = kSanitized ? 40 : 200;
    for (int frame = 0; frame < frames; ++frame) {
      const double angle = 10.0 * frame / frames;
      parameters.view.camera.position = {1.6 * std::cos(angle), 1.6 * std::sin(angle), 0.3};
      parameters.view.camera.target = {0, 0, 0};
      dropped += streamer.update(parameters).cut.dropped.size();
      CHECK(streamer.mesh().resident_bytes() <= parameters.max_bytes);
      lists += streamer.mesh().shown_cuts().size();
      if (frame % 20 != 0) continue;
      finish(streamer, parameters);
      // With levels the blocks take more, once those are there.
      for (int more = 0; in_levels && more < 100; ++more) {
        streamer.wait(std::chrono::milliseconds(20));
        dropped += streamer.update(parameters).cut.dropped.size();
        CHECK(streamer.mesh().resident_bytes() <= parameters.max_bytes);
        if (streamer.mesh().missing_levels().empty()) break;
      }
      if (in_levels) {
        check_by_vertex(streamer.mesh());
      } else {
        check_shown(file, streamer.mesh(), refined_blocks(file, streamer.mesh()));
      }
    }
    CHECK(dropped > 0);
    CHECK((lists > 0) == in_levels);
  }
}

TEST_CASE("a budget by triangles is kept in every mode, at every moment" *
          doctest::test_suite("threads")) {
  const EncodedCase c = simplified_case(smooth_sphere(60, 90), 300, 14, kCoarsePrecision);
  const BlockFile file = opened(c.bytes);
  enum class Mode { Whole, InLevels, ByVertex };
  for (const Mode mode : {Mode::Whole, Mode::InLevels, Mode::ByVertex}) {
    BlockStreamer streamer = opened_streamer(file, async_memory_source(c.bytes), hasty(1));
    BlockViewParameters parameters = view_of_all();
    parameters.view.camera.pixels = 4;
    parameters.in_levels = mode != Mode::Whole;
    parameters.by_vertex = mode == Mode::ByVertex;
    std::size_t before = 0;
    for (const std::size_t triangles : {500, 2000, 1000, 3000}) {
      parameters.view.max_triangles = triangles;
      for (int more = 0; more < 200; ++more) {
        const bool is_complete = streamer.update(parameters).is_complete;
        CHECK(streamer.mesh().triangle_count() <= triangles);
        if (is_complete && streamer.mesh().missing_levels().empty()) break;
        streamer.wait(std::chrono::milliseconds(20));
      }
      CHECK(streamer.mesh().triangle_count() != before);
      before = streamer.mesh().triangle_count();
    }
  }
}

TEST_CASE("a directory page that is not as long as it should be is asked for again" *
          doctest::test_suite("threads")) {
  const EncodedCase c = small_case();
  const BlockFile file = opened(c.bytes);
  for (const Fault fault : {Fault::Truncated, Fault::Longer, Fault::Corrupted}) {
    const auto source = std::make_shared<FaultySource>(c.bytes);
    BlockStreamer streamer = opened_streamer(file, source, hasty(0));
    streamer.update(view_of_all());
    REQUIRE(source->waiting_count() == 1);
    source->answer(0, fault, 5);
    streamer.update(view_of_all());
    CHECK(streamer.trouble().has_value());
    for (int updates = 0; !streamer.update(view_of_all()).is_complete; ++updates) {
      REQUIRE(updates < 10'000);
      streamer.wait(std::chrono::milliseconds(5));
      source->answer_all();
    }
    CHECK(!streamer.trouble());
    CHECK(streamer.mesh().triangle_count() == c.mesh.triangle_count());
  }
}

}  // namespace
}  // namespace crease

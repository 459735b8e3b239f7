// The whole way from answers to what is drawn. The first byte says which:
//
// even: a sound file whose answers are late, in any order, wrong, or of another file, and views of
//       all modes, as the bytes say. At every update what is shown is a cut of blocks that are
//       those of the file, without a crack and within the budget; once answers are right, all
//       comes.
// odd:  the rest is the file, checksums made right, and its answers are what it says. It is
//       refused, or what is shown of it is a mesh, in every mode and within the budget.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "base/assert.h"
#include "codec/repair_checksums.h"
#include "crease/block_streamer.h"
#include "crease/build.h"
#include "crease/decode_model.h"
#include "runtime/block_mesh_oracle.h"
#include "runtime/block_vertices_oracle.h"
#include "runtime/faulty_source.h"
#include "runtime/shown_surface.h"
#include "support/mesh_zoo.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <vector>

namespace crease {
namespace {

constexpr int kMostUpdates = 5000;  // until all is there, one block each

// Zeros once it is over.
class Script {
 public:
  explicit Script(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool is_over() const { return at_ >= bytes_.size(); }
  std::size_t next() { return is_over() ? 0 : bytes_[at_++]; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

// Closed, in some twenty blocks.
std::vector<std::byte> built(const Mesh& mesh) {
  BuildOptions options;
  options.simplify.patch_triangles = 80;
  options.simplify.threads = 1;
  Result<Built> model = build_model(mesh, options);
  CREASE_ASSERT(model.ok());
  return std::move(model->file_bytes);
}

struct Sound {
  std::vector<std::byte> bytes = built(smooth_sphere(12, 22)),
                         other = built(faceted_sphere(10, 18));
  BlockFile file = *BlockFile::open(memory_source(std::span<const std::byte>(bytes)));
  std::vector<std::uint64_t> checksums = *drawn_checksums(file);
  // Of memory, at most. The base's: and its hierarchy, which is kept with it once it was by vertex.
  std::size_t base_bytes = 0, all_bytes = 0;

  Sound() {
    const BlockMesh mesh = *BlockMesh::open(file);
    const DirectoryPage page = *file.read_page(0);
    for (const BlockEntry& entry : page.blocks) {
      all_bytes += mesh.bytes_of(entry.facts);
      if (entry.id == BlockId{0}) base_bytes = 2 * all_bytes;
    }
  }
};

const Sound& sound() {
  static const Sound made;
  return made;
}

BlockViewParameters view_of(Script& script, std::size_t base_bytes, std::size_t all_bytes) {
  const std::size_t which = script.next(), how = script.next();
  constexpr double kPixels[] = {1e-30, 0.5, 4, 32};
  constexpr Vec3d kEyes[] = {{0, 0, 3}, {1.2, 0.4, 0.3}, {-0.5, 1.1, 0}, {0.2, -4, 1}};
  BlockViewParameters parameters;
  parameters.view.camera.position = kEyes[which % 4];
  parameters.view.camera.target = {0, 0, 0};
  parameters.view.camera.pixels = kPixels[which / 4 % 4];
  parameters.view.coarse_outside = which / 16 % 2 != 0;
  parameters.view.degrees = which / 32 % 2 * 5.0;
  if (which >= 192) parameters.view.max_triangles = 300;
  parameters.by_vertex = how % 4 == 3;
  parameters.in_levels = how % 2 != 0;
  parameters.max_bytes = base_bytes + all_bytes * (how / 4) / 48;  // 64 values; 48: all of it fits
  return parameters;
}

// Which blocks are refined and what of which blocks is drawn.
using Picture = std::vector<std::uint64_t>;

Picture picture_of(const BlockMesh& mesh, const BlockSet& refined) {
  Picture picture;
  for (const BlockId id : refined) picture.push_back(index_of(id));
  for (const ShownRange& r : mesh.shown()) {
    for (const Range& part : {r.sn, r.fn, r.nsn}) {
      picture.insert(picture.end(), {index_of(r.block->id()), part.first, part.count});
    }
  }
  return picture;
}

// Those that are shown are those of the file, and it is a cut.
void check_sound(const BlockMesh& mesh, const BlockViewParameters& parameters) {
  // By vertex, cuts that grow may exceed it until the next update.
  CREASE_ASSERT(parameters.by_vertex || mesh.resident_bytes() <= parameters.max_bytes);
  CREASE_ASSERT(mesh.triangle_count() <= std::max<std::size_t>(parameters.view.max_triangles, 300));
  CREASE_ASSERT(wrong_blocks(mesh, sound().checksums) == 0);
  const BlockSet refined = refined_blocks(sound().file, mesh);
  if (refined.empty()) return;
  // What whole blocks show has mostly been looked at before: the same of the same file.
  static std::set<Picture> looked_at;
  const bool is_whole = mesh.shown_cuts().empty();
  if (is_whole && !looked_at.insert(picture_of(mesh, refined)).second) return;
  CREASE_ASSERT(open_edges(mesh) == 0);
  if (is_whole) {
    check_shown(sound().file, mesh, refined);
  } else {
    check_by_vertex(mesh);
  }
}

void finish(BlockStreamer& streamer, FaultySource& source, const BlockViewParameters& parameters) {
  for (int updates = 0;; ++updates) {
    CREASE_ASSERT(updates < kMostUpdates);
    source.answer_all();
    if (streamer.update(parameters).is_complete) return;
  }
}

StreamOptions at_once() {
  return {.decode_threads = 0, .prefetch_frames = 3, .first_pause = std::chrono::milliseconds(0)};
}

void stream_sound_file(Script script) {
  const auto source = std::make_shared<FaultySource>(sound().bytes, sound().other);
  Result<BlockStreamer> streamer = BlockStreamer::open(sound().file, source, at_once());
  CREASE_ASSERT(streamer.ok());
  while (!script.is_over()) {
    const BlockViewParameters parameters = view_of(script, sound().base_bytes, sound().all_bytes);
    for (std::size_t frames = 1 + script.next() % 4; frames > 0; --frames) {
      for (std::size_t answers = script.next() % 8; answers > 0; --answers) {
        const std::size_t which = script.next(), fault = script.next();
        if (source->waiting_count() == 0) continue;
        source->answer(which % source->waiting_count(), Fault(fault % kFaultCount),
                       fault * 31 + which);
      }
      streamer->update(parameters);
      check_sound(streamer->mesh(), parameters);
    }
  }
  const BlockViewParameters all = view_of_all();
  finish(*streamer, *source, all);
  check_sound(streamer->mesh(), all);
  CREASE_ASSERT(streamer->mesh().error().surface == 0 && !streamer->trouble());
}

// What is drawn has its corners, and nothing that is no number.
void check_drawn(const DrawList& list) {
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (const std::uint32_t v : part->indices) CREASE_ASSERT(v < list.positions.size());
  }
  for (const Vec3f& p : list.positions) CREASE_ASSERT(std::isfinite(p.x + p.y + p.z));
}

void stream_hostile_file(std::span<const std::uint8_t> data) {
  const std::span<const std::byte> given = std::as_bytes(data);
  std::vector<std::byte> bytes(given.begin(), given.end());
  repair_checksums(bytes);
  Result<BlockStreamer> streamer = BlockStreamer::open(async_memory_source(bytes), at_once());
  if (!streamer.ok()) return;
  constexpr std::uint8_t kViews[] = {0, 252, 0, 253, 0, 255, 37, 31, 18, 253};
  Script script(kViews);
  while (!script.is_over()) {
    BlockViewParameters parameters = view_of(script, std::size_t(1) << 20, std::size_t(1) << 22);
    for (int updates = 0; updates < 24; ++updates) {
      const bool is_complete = streamer->update(parameters).is_complete;
      const BlockMesh& mesh = streamer->mesh();
      for (const ShownRange& range : mesh.shown()) check_drawn(range.block->draw_list());
      for (const ShownCut& cut : mesh.shown_cuts()) check_drawn(cut.list);
      if (is_complete && mesh.missing_levels().empty()) break;
    }
    CREASE_ASSERT(check_mesh(streamer->mesh().extract()).ok());
  }
}

}  // namespace
}  // namespace crease

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // What the oracles check ends the program if it does not hold.
  static doctest::Context context;
  context.setAsDefaultForAssertsOutOfTestCases();
  if (size == 0) return 0;
  const std::span<const std::uint8_t> rest = std::span(data, size).subspan(1);
  if (data[0] % 2 == 0) {
    crease::stream_sound_file(crease::Script(rest));
  } else {
    crease::stream_hostile_file(rest);
  }
  return 0;
}

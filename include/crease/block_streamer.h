// Feeds a BlockMesh from a source that takes its time: asks for what the view misses, decodes it on
// threads of its own, and never makes a frame wait for either. What a frame takes beside is its own
// moves, by vertex those of all that came: view.max_seconds bounds them.
//
//   Result<BlockStreamer> streamer = BlockStreamer::open(open_async_http(url));
//   every frame:
//     streamer->update({.view = {.camera = camera}, .max_bytes = 256 << 20});
//     for (const ShownRange& range : streamer->mesh().shown()) draw(*range.block, range);
//     for (const ShownCut& cut : streamer->mesh().shown_cuts()) draw(cut.list);
//
// Several views of one model, for pictures side by side:
//
//   streamer->set_view_count(2);
//   every frame: for (std::size_t v = 0; v < 2; ++v) streamer->update(parameters[v], v);
//
// By vertex, hierarchies are made on the threads that decode, when there is nothing to decode;
// until then blocks are shown whole. So are levels by block, once no block is missing.
//
// Images of textures lie at the file's end and are not streamed: BlockFile::read_images() reads
// them, on a thread of the program's own and from a source of its own where it takes long.
//
// Memory: what BlockViewParameters::max_bytes allows of resident blocks, and beside that at most
// StreamOptions::max_pending_bytes of payloads, what the source keeps of those that came for
// nothing (AsyncOptions::max_kept_bytes), of each thread the BlockFacts::decoded_bytes of what it
// decodes, and eight decoded blocks that wait for the next update().
//
// Threads: one at a time calls a streamer. Its own ones decode, and touch nothing that it shows.
#pragma once

#include "crease/async_source.h"
#include "crease/block_mesh.h"
#include "crease/result.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace crease {

struct StreamOptions {
  int decode_threads = 1;  // 0: update() decodes a block itself, in a browser without threads
  // Of payloads that are asked for, or wait for what they need. At least one block's.
  std::size_t max_pending_bytes = std::size_t(1) << 20;
  // With nothing missing, what will be missing if the camera goes on like this for so many frames.
  // 0: nothing.
  int prefetch_frames = 30;
  // Before a block that failed is asked for again; twice as long each further time, up to a minute.
  std::chrono::milliseconds first_pause{500};
  // Asked ten times a second while open() waits; true ends it with Interrupted.
  std::function<bool()> stopped{};
};

struct StreamReport {
  BlockUpdate cut;
  std::size_t inserted = 0;  // blocks
  // All that the view wants is there, and shown. By block, levels may still come that show it with
  // far fewer triangles, until BlockMesh::missing_levels() is empty.
  bool is_complete = false;
};

// Since the streamer was opened.
struct StreamStatistics {
  AsyncStatistics source;
  std::size_t blocks_decoded = 0, blocks_dropped = 0, blocks_prefetched = 0, blocks_failed = 0;
  std::size_t pending_requests = 0;  // now
  std::size_t pending_bytes = 0;     // now, of payloads
  double decode_seconds = 0;         // of all threads
};

class BlockStreamer {
 public:
  // Waits for the head and the schema, which mostly are in the first 64 KiB; of a host these are
  // one request, out of which the first picture comes as well. Nothing else may be asked of the
  // source. `options.stopped` ends the wait.
  static Result<BlockStreamer> open(AsyncSourcePtr source, const StreamOptions& options = {});
  // Of a file whose head has been read. `source`: of the same bytes.
  static Result<BlockStreamer> open(const BlockFile& file, AsyncSourcePtr source,
                                    const StreamOptions& options = {});
  ~BlockStreamer();
  BlockStreamer(BlockStreamer&&) noexcept;

  // Takes what has arrived, moves the cut, and asks for what is missing. Never waits. Time: that of
  // BlockMesh::update() and of what arrived.
  StreamReport update(const BlockViewParameters& parameters, std::size_t view = 0);

  // 1 to kMaxViews; begins with 1. Each has a cut and a mesh of its own. What one view has and
  // another one misses is taken from there: it is asked for and decoded once, and in memory once,
  // though max_bytes of each view counts it. Views that go leave their blocks only to the others
  // that have them.
  static constexpr std::size_t kMaxViews = 8;
  void set_view_count(std::size_t count);
  std::size_t view_count() const;

  const BlockMesh& mesh(std::size_t view = 0) const;
  const BlockFileHead& head() const;
  StreamStatistics statistics() const;
  // The last thing that went wrong, while it has not gone right since. What is shown is right all
  // the same, only coarser.
  const std::optional<Failure>& trouble() const;

  // For tools: until update() has something to do, or the time is over (false).
  bool wait(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  explicit BlockStreamer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crease

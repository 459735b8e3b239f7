// What a streamer keeps, for what it asks for (block_streamer_asks.cpp) and for what comes of it
// (block_streamer.cpp).
#pragma once

#include "crease/block_streamer.h"
#include "runtime/decode_workers.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace crease {

struct BlockStreamer::Impl {
  using Clock = std::chrono::steady_clock;

  // On its way from the source to the mesh.
  struct Pending {
    BlockEntry entry;
    enum class State { Asked, Waiting, Decoding } state = State::Asked;
    Ticket ticket{};                 // Asked
    std::vector<std::byte> payload;  // Waiting, for what it needs
    std::uint32_t wanted_by = 0;     // a bit for each of the present views
    bool is_prefetch = false;
  };

  struct Pause {
    std::chrono::milliseconds length{0};
    Clock::time_point until;
  };

  Impl(BlockFileHead h, BlockMesh m, AsyncSourcePtr s, const StreamOptions& o)
      : head(std::move(h)), source(std::move(s)), options(o), workers(o.decode_threads) {
    meshes.push_back(std::move(m));
    lacks_names = head.part_count > 0;
  }

  StreamReport update(const BlockViewParameters& parameters, std::size_t view);
  void take_answers();
  void take_page(Result<std::vector<std::byte>> bytes);
  void take_names_section(Result<std::vector<std::byte>> bytes);
  void take_names();
  void take_payload(BlockId id, Result<std::vector<std::byte>> bytes);
  void take_decoded(StreamReport& report);
  void take_from_others(std::size_t view, StreamReport& report);
  void take_hierarchies();
  void make_hierarchies(std::size_t view);
  void make_levels(std::size_t view);
  bool others_have(BlockId id) const;
  void ask_for_page();
  void ask_for_names();
  void ask_for_blocks(const BlockViewParameters& parameters, std::size_t view);
  void ask_for(std::span<const BlockEntry> missing, std::size_t view, bool is_prefetch);
  void want(std::span<const BlockEntry> entries, std::size_t view);
  bool is_nothing_missing() const {
    return std::all_of(meshes.begin(), meshes.end(),
                       [](const BlockMesh& mesh) { return mesh.missing().empty(); });
  }
  void forget_unwanted();
  void decode_what_can_be();
  std::optional<BlockDecodeJob> decode_job(BlockId id) const;
  void lengthen(Pause& pause) const {
    constexpr std::chrono::milliseconds kLongestPause{60'000};
    pause.length = std::clamp(2 * pause.length, options.first_pause, kLongestPause);
    pause.until = Clock::now() + pause.length;
  }
  void note_failure(BlockId id, const Failure& failure);
  bool is_paused(BlockId id) const;
  bool waits_in_vain(BlockId id) const;
  std::vector<BlockEntry> missing_soon(const BlockViewParameters& parameters);
  // What other threads have allocated is better freed by them.
  template <typename Thing>
  void free(Thing thing) {
    workers.free(std::make_shared<const Thing>(std::move(thing)));
  }
  std::size_t most_decoding() const {
    constexpr std::size_t kDecodingPerThread = 8;  // so that none is idle between two frames
    return kDecodingPerThread * std::size_t(std::max(options.decode_threads, 1));
  }

  BlockFileHead head;
  std::vector<BlockMesh> meshes;  // one a view; all have the same pages
  AsyncSourcePtr source;
  StreamOptions options;
  std::set<BlockId> making;  // hierarchies
  std::set<BlockId> making_levels;
  std::map<BlockId, Pending> pending;  // by id: coarse ones first
  std::unordered_map<std::uint64_t, BlockId> block_of_ticket;
  std::size_t pending_bytes = 0;
  std::optional<Ticket> page_ticket, names_ticket;
  bool lacks_names = false;
  Pause page_pause, names_pause;
  std::map<BlockId, Pause> paused;
  std::optional<Failure> trouble;
  std::optional<Camera> last_camera;
  int updates = 0;
  StreamStatistics statistics;
  DecodeWorkers workers;  // the last one: its threads end before what they use
};

}  // namespace crease

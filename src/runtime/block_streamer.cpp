#include "crease/block_streamer.h"

#include "base/assert.h"
#include "codec/decode_container.h"
#include "runtime/decode_workers.h"
#include "stream/waiting_source.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace crease {

namespace {

using Clock = std::chrono::steady_clock;

constexpr float kPagePriority = 1e9f;          // before any block
constexpr std::size_t kDecodingPerThread = 8;  // so that none is idle between two frames
constexpr int kUpdatesBetweenPrefetches = 8;
constexpr std::chrono::milliseconds kLongestPause{60'000};

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

}  // namespace

struct BlockStreamer::Impl {
  Impl(BlockFileHead h, BlockMesh m, AsyncSourcePtr s, const StreamOptions& o)
      : head(std::move(h)), source(std::move(s)), options(o), workers(o.decode_threads) {
    meshes.push_back(std::move(m));
    lacks_names = head.part_count > 0;
  }

  StreamReport update(const BlockViewParameters& parameters, std::size_t view);
  void take_answers();
  void take_page(Result<std::vector<std::byte>> bytes);
  void take_names(const Result<std::vector<std::byte>>& bytes);
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

StreamReport BlockStreamer::Impl::update(const BlockViewParameters& parameters, std::size_t view) {
  StreamReport report;
  take_answers();
  take_decoded(report);
  take_hierarchies();
  take_from_others(view, report);
  BlockMesh& mesh = meshes[view];
  report.cut = mesh.update(parameters);
  statistics.blocks_dropped += report.cut.dropped.size();
  workers.free(mesh.take_unused());
  ask_for_page();
  ask_for_names();
  ask_for_blocks(parameters, view);
  forget_unwanted();
  decode_what_can_be();
  make_hierarchies(view);
  make_levels(view);
  workers.hand_over();
  report.is_complete = mesh.missing().empty() && !mesh.next_page() &&
                       mesh.missing_hierarchies().empty() && mesh.has_arrived();
  return report;
}

void BlockStreamer::Impl::take_answers() {
  std::vector<AsyncAnswer> answers = source->poll();
  if (answers.empty()) return;
  for (AsyncAnswer& answer : answers) {
    if (names_ticket == answer.ticket) {
      take_names(answer.bytes);
      continue;
    }
    if (page_ticket == answer.ticket) {
      page_ticket.reset();
      take_page(std::move(answer.bytes));
      continue;
    }
    const auto at = block_of_ticket.find(static_cast<std::uint64_t>(answer.ticket));
    if (at == block_of_ticket.end()) continue;  // cancelled too late
    const BlockId id = at->second;
    block_of_ticket.erase(at);
    take_payload(id, std::move(answer.bytes));
  }
  free(std::move(answers));
}

void BlockStreamer::Impl::take_page(Result<std::vector<std::byte>> bytes) {
  const std::uint32_t page = *meshes.front().next_page();
  Status added = Done{};
  if (bytes.ok() && bytes->size() != head.pages[page].bytes) {
    added = fail(Error::Truncated, source->name() + ": an answer is not as long as was asked for");
  } else if (bytes.ok()) {
    const Result<DirectoryPage> decoded = decode_page(*bytes, head, page, Checksums::Verify);
    added = decoded.ok() ? Status(Done{}) : Status(decoded.failure());
    for (std::size_t v = 0; added.ok() && v < meshes.size(); ++v) {
      added = meshes[v].add_page(*decoded);  // fails for the first one or for none
    }
  } else {
    added = bytes.failure();
  }
  if (added.ok()) {
    page_pause = {};
    trouble.reset();
    return;
  }
  trouble = added.failure();
  lengthen(page_pause);
}

// Nothing that is shown waits for them, so that it is no trouble if they fail.
void BlockStreamer::Impl::take_names(const Result<std::vector<std::byte>>& bytes) {
  names_ticket.reset();
  if (bytes.ok() && checksum(*bytes) == head.parts.checksum) {
    Result<std::vector<std::string>> names = decode_parts(*bytes, head.part_count);
    lacks_names = false;
    if (!names.ok()) return;
    for (BlockMesh& mesh : meshes) mesh.set_part_names(*names);
    return;
  }
  lengthen(names_pause);
}

void BlockStreamer::Impl::take_payload(BlockId id, Result<std::vector<std::byte>> bytes) {
  const auto at = pending.find(id);
  if (!bytes.ok()) return note_failure(id, bytes.failure());
  at->second.state = Pending::State::Waiting;
  at->second.payload = *std::move(bytes);
}

void BlockStreamer::Impl::note_failure(BlockId id, const Failure& failure) {
  pending_bytes -= pending.at(id).entry.bytes;
  pending.erase(id);
  ++statistics.blocks_failed;
  trouble = failure;
  lengthen(paused[id]);
}

bool BlockStreamer::Impl::is_paused(BlockId id) const {
  const auto at = paused.find(id);
  return at != paused.end() && Clock::now() < at->second.until;
}

void BlockStreamer::Impl::take_decoded(StreamReport& report) {
  for (DecodeWorkers::Decoded& decoded : workers.take()) {
    if (!decoded.block.ok()) {
      note_failure(decoded.id, decoded.block.failure());
      continue;
    }
    const auto at = pending.find(decoded.id);
    // What nobody wants any more is there for the first one.
    const std::uint32_t wanted_by = at->second.wanted_by != 0 ? at->second.wanted_by : 1;
    statistics.blocks_prefetched += at->second.is_prefetch;
    pending_bytes -= at->second.entry.bytes;
    pending.erase(at);
    if (paused.erase(decoded.id) > 0 && paused.empty()) trouble.reset();
    ++statistics.blocks_decoded;
    for (std::size_t v = 0; v < meshes.size(); ++v) {
      if ((wanted_by >> v & 1) != 0) meshes[v].insert(*decoded.block);
    }
    workers.free(*std::move(decoded.block));  // in case that the views drop it at once
    ++report.inserted;
  }
}

void BlockStreamer::Impl::take_from_others(std::size_t view, StreamReport& report) {
  if (meshes.size() == 1) return;
  for (const BlockEntry& entry : meshes[view].missing()) {
    for (const BlockMesh& other : meshes) {
      ResidentBlockPtr block = other.resident(entry.id);
      if (!block) continue;
      meshes[view].insert(std::move(block));
      ++report.inserted;
      break;
    }
  }
}

void BlockStreamer::Impl::take_hierarchies() {
  for (BlockHierarchyPtr& hierarchy : workers.take_hierarchies()) {
    making.erase(hierarchy->id());
    for (BlockMesh& mesh : meshes) mesh.insert(hierarchy);
    workers.free(std::move(hierarchy));  // in case that the views have dropped the block
  }
  for (BlockLevelsPtr& levels : workers.take_levels()) {
    making_levels.erase(levels->id());
    for (BlockMesh& mesh : meshes) mesh.insert(levels);
    workers.free(std::move(levels));
  }
}

// Of blocks that are shown, so that they are resident, and so is what they need.
void BlockStreamer::Impl::make_hierarchies(std::size_t view) {
  const std::span<const BlockId> missing = meshes[view].missing_hierarchies();
  for (const BlockId id : std::vector<BlockId>(missing.begin(), missing.end())) {
    if (making.size() >= most_decoding()) return;
    if (making.contains(id)) continue;
    const auto other = std::find_if(meshes.begin(), meshes.end(), [id](const BlockMesh& mesh) {
      return mesh.hierarchy(id) != nullptr;
    });
    if (other != meshes.end()) {
      meshes[view].insert(other->hierarchy(id));
    } else if (std::optional<BlockHierarchyJob> job = meshes[view].hierarchy_job(id)) {
      making.insert(id);
      workers.add(*std::move(job));
    }
  }
}

// Few at a time, and none while the view misses blocks: those are worth more, and decoded sooner.
void BlockStreamer::Impl::make_levels(std::size_t view) {
  if (!meshes[view].missing().empty()) return;
  const std::size_t most = 1 + std::size_t(std::max(options.decode_threads, 0));
  for (const BlockId id : meshes[view].missing_levels()) {
    if (making_levels.size() >= most) return;
    if (making_levels.contains(id)) continue;
    if (std::optional<BlockLevelsJob> job = meshes[view].levels_job(id)) {
      making_levels.insert(id);
      workers.add(*std::move(job));
    }
  }
}

bool BlockStreamer::Impl::others_have(BlockId id) const {
  return std::any_of(meshes.begin(), meshes.end(),
                     [id](const BlockMesh& mesh) { return mesh.is_resident(id); });
}

// Names last: once the views have what they want.
void BlockStreamer::Impl::ask_for_names() {
  if (!lacks_names || names_ticket || Clock::now() < names_pause.until) return;
  const BlockMesh& mesh = meshes.front();
  if (mesh.next_page() || mesh.shown().empty() || !is_nothing_missing()) return;
  names_ticket = source->request(head.parts.range, 0);
}

void BlockStreamer::Impl::ask_for_page() {
  const std::optional<std::uint32_t> page = meshes.front().next_page();
  if (!page || page_ticket || Clock::now() < page_pause.until) return;
  page_ticket = source->request(head.pages[*page], kPagePriority);
}

void BlockStreamer::Impl::want(std::span<const BlockEntry> entries, std::size_t view) {
  for (const BlockEntry& entry : entries) {
    if (const auto at = pending.find(entry.id); at != pending.end()) {
      at->second.wanted_by |= std::uint32_t(1) << view;
    }
  }
}

void BlockStreamer::Impl::ask_for_blocks(const BlockViewParameters& parameters, std::size_t view) {
  for (auto& [id, p] : pending) p.wanted_by &= ~(std::uint32_t(1) << view);
  want(meshes[view].missing(), view);
  ask_for(meshes[view].missing(), view, false);
  if (view != 0) return;  // the first one's camera tells for all where they go
  const std::vector<BlockEntry> soon = missing_soon(parameters);
  want(soon, view);
  ask_for(soon, view, true);
  last_camera = parameters.view.camera;
}

// In their order, as far as there is room, and with what they need on its way.
void BlockStreamer::Impl::ask_for(std::span<const BlockEntry> missing, std::size_t view,
                                  bool is_prefetch) {
  const BlockMesh& mesh = meshes[view];
  std::vector<RangeRequest> requests;
  std::vector<BlockId> ids;
  float priority = is_prefetch ? 0 : static_cast<float>(missing.size());
  for (const BlockEntry& entry : missing) {
    if (pending_bytes > 0 && pending_bytes + entry.bytes > options.max_pending_bytes) break;
    priority -= 1;
    if (pending.contains(entry.id) || is_paused(entry.id) || others_have(entry.id)) continue;
    const std::vector<BlockId> needed = mesh.lacking(entry.id);
    // What another view has will be here with the next update.
    if (!std::all_of(needed.begin(), needed.end(),
                     [this](BlockId id) { return others_have(id) || pending.contains(id); })) {
      continue;
    }
    pending[entry.id] = {.entry = entry,
                         .payload = {},
                         .wanted_by = std::uint32_t(1) << view,
                         .is_prefetch = is_prefetch};
    pending_bytes += entry.bytes;
    requests.push_back({{entry.offset, entry.bytes}, priority});
    ids.push_back(entry.id);
  }
  if (requests.empty()) return;
  const Ticket first = source->request(requests);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Ticket ticket = ticket_after(first, i);
    pending[ids[i]].ticket = ticket;
    block_of_ticket[static_cast<std::uint64_t>(ticket)] = ids[i];
  }
}

// If the camera goes on as from the last view to this one.
std::vector<BlockEntry> BlockStreamer::Impl::missing_soon(const BlockViewParameters& parameters) {
  const Camera& now = parameters.view.camera;
  if (++updates % kUpdatesBetweenPrefetches != 0 || options.prefetch_frames == 0 || !last_camera ||
      !is_nothing_missing() || pending_bytes > options.max_pending_bytes / 2 ||
      (last_camera->position == now.position && last_camera->target == now.target)) {
    return {};
  }
  BlockViewParameters soon = parameters;
  const double frames = options.prefetch_frames;
  soon.view.camera.position = now.position + (now.position - last_camera->position) * frames;
  soon.view.camera.target = now.target + (now.target - last_camera->target) * frames;
  return meshes.front().missing_for(soon);
}

// What it needs was with another view, which has dropped it, and nobody has asked for it again.
bool BlockStreamer::Impl::waits_in_vain(BlockId id) const {
  const std::vector<BlockId> needed = meshes.front().lacking(id);
  return std::any_of(needed.begin(), needed.end(),
                     [this](BlockId n) { return !pending.contains(n) && !others_have(n); });
}

// What was prefetched may come while nobody else needs its room.
void BlockStreamer::Impl::forget_unwanted() {
  const bool has_room = is_nothing_missing() || pending_bytes <= options.max_pending_bytes / 2;
  for (auto at = pending.begin(); at != pending.end();) {
    Pending& p = at->second;
    const bool is_wanted = p.wanted_by != 0 || (p.is_prefetch && has_room);
    if (p.state == Pending::State::Decoding || (is_wanted && !waits_in_vain(at->first))) {
      ++at;
      continue;
    }
    if (p.state == Pending::State::Asked) {
      source->cancel(p.ticket);
      block_of_ticket.erase(static_cast<std::uint64_t>(p.ticket));
    }
    if (!p.payload.empty()) free(std::move(p.payload));
    pending_bytes -= p.entry.bytes;
    at = pending.erase(at);
  }
}

std::optional<BlockDecodeJob> BlockStreamer::Impl::decode_job(BlockId id) const {
  for (const BlockMesh& mesh : meshes) {
    if (std::optional<BlockDecodeJob> job = mesh.decode_job(id)) return job;
  }
  return std::nullopt;
}

void BlockStreamer::Impl::decode_what_can_be() {
  for (auto& [id, p] : pending) {
    if (workers.outstanding() >= most_decoding()) return;
    if (p.state != Pending::State::Waiting) continue;
    std::optional<BlockDecodeJob> job = decode_job(id);
    if (!job) continue;
    p.state = Pending::State::Decoding;
    workers.add(*std::move(job), std::move(p.payload));
  }
}

Result<BlockStreamer> BlockStreamer::open(AsyncSourcePtr source, const StreamOptions& options) {
  const auto waiting = std::make_shared<const WaitingSource>(source, options.stopped);
  if (Status status = waiting->begin(); !status.ok()) return status.failure();
  const Result<BlockFile> file = BlockFile::open(waiting);
  if (!file.ok()) return file.failure();
  return open(*file, std::move(source), options);
}

Result<BlockStreamer> BlockStreamer::open(const BlockFile& file, AsyncSourcePtr source,
                                          const StreamOptions& options) {
  Result<BlockMesh> mesh = BlockMesh::open(file);
  if (!mesh.ok()) return mesh.failure();
  return BlockStreamer(
      std::make_unique<Impl>(file.head(), *std::move(mesh), std::move(source), options));
}

BlockStreamer::BlockStreamer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BlockStreamer::~BlockStreamer() = default;
BlockStreamer::BlockStreamer(BlockStreamer&&) noexcept = default;

StreamReport BlockStreamer::update(const BlockViewParameters& parameters, std::size_t view) {
  CREASE_ASSERT(view < view_count());
  return impl_->update(parameters, view);
}

void BlockStreamer::set_view_count(std::size_t count) {
  CREASE_ASSERT(count >= 1 && count <= kMaxViews);
  std::vector<BlockMesh>& meshes = impl_->meshes;
  while (meshes.size() > count) meshes.pop_back();
  while (meshes.size() < count) meshes.push_back(meshes.front().another());
  const std::uint32_t all = (std::uint32_t(1) << count) - 1;
  for (auto& [id, p] : impl_->pending) p.wanted_by &= all;
}

std::size_t BlockStreamer::view_count() const {
  return impl_->meshes.size();
}

const BlockFileHead& BlockStreamer::head() const {
  return impl_->head;
}

const BlockMesh& BlockStreamer::mesh(std::size_t view) const {
  CREASE_ASSERT(view < view_count());
  return impl_->meshes[view];
}

StreamStatistics BlockStreamer::statistics() const {
  StreamStatistics statistics = impl_->statistics;
  statistics.source = impl_->source->statistics();
  statistics.pending_requests = impl_->block_of_ticket.size();
  statistics.pending_bytes = impl_->pending_bytes;
  statistics.decode_seconds = impl_->workers.seconds();
  return statistics;
}

const std::optional<Failure>& BlockStreamer::trouble() const {
  return impl_->trouble;
}

bool BlockStreamer::wait(std::chrono::milliseconds timeout) {
  constexpr std::chrono::milliseconds kLook{2};  // at the one while waiting for the other
  const Clock::time_point end = Clock::now() + timeout;
  const auto is_on_its_way = [](const BlockMesh& mesh) { return !mesh.has_arrived(); };
  if (std::any_of(impl_->meshes.begin(), impl_->meshes.end(), is_on_its_way)) return true;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    const DecodeWorkers& workers = impl_->workers;
    const bool is_decoding = workers.outstanding() + workers.outstanding_making() > 0;
    if (is_decoding && impl_->options.decode_threads == 0) return true;
    if (is_decoding && impl_->workers.wait(std::min(left, kLook))) return true;
    if (impl_->source->wait(is_decoding ? std::min(left, kLook) : left)) return true;
    if (left <= std::chrono::milliseconds(0)) return false;
    if (!is_decoding) {
      std::this_thread::sleep_for(std::min(left, kLook));  // nothing is outstanding: a pause
      return Clock::now() < end;
    }
  }
}

}  // namespace crease

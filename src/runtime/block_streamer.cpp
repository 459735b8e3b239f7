#include "crease/block_streamer.h"

#include "base/assert.h"
#include "codec/decode_container.h"
#include "runtime/block_streamer_impl.h"
#include "stream/waiting_source.h"

#include <algorithm>
#include <utility>

namespace crease {

StreamReport BlockStreamer::Impl::update(const BlockViewParameters& parameters, std::size_t view) {
  StreamReport report;
  take_answers();
  take_decoded(report);
  take_hierarchies();
  take_names();
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
      take_names_section(std::move(answer.bytes));
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
void BlockStreamer::Impl::take_names_section(Result<std::vector<std::byte>> bytes) {
  names_ticket.reset();
  if (bytes.ok() && checksum(*bytes) == head.parts.checksum) {
    lacks_names = false;
    workers.add({*std::move(bytes), head.part_count});
    return;
  }
  lengthen(names_pause);
}

void BlockStreamer::Impl::take_names() {
  for (std::vector<std::string>& names : workers.take_names()) {
    for (std::size_t v = meshes.size(); v-- > 1;) meshes[v].set_part_names(names);
    meshes.front().set_part_names(std::move(names));
  }
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
    if (std::optional<BlockLevelsJob> job = meshes[view].levels_job(id, meshes)) {
      making_levels.insert(id);
      workers.add(*std::move(job));
    }
  }
}

bool BlockStreamer::Impl::others_have(BlockId id) const {
  return std::any_of(meshes.begin(), meshes.end(),
                     [id](const BlockMesh& mesh) { return mesh.is_resident(id); });
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
  using Clock = Impl::Clock;
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

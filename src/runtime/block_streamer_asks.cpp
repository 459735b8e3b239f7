// What a streamer asks its source for, and what it no longer wants.
#include "runtime/block_streamer_impl.h"

#include <algorithm>

namespace crease {

namespace {

constexpr float kPagePriority = 1e9f;  // before any block
constexpr int kUpdatesBetweenPrefetches = 8;

}  // namespace

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
    if (!p.payload.empty()) source->give_back(p.entry.offset, std::move(p.payload));
    pending_bytes -= p.entry.bytes;
    at = pending.erase(at);
  }
}

}  // namespace crease

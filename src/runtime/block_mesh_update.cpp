// How a block mesh follows a view: what is chosen, what of it can be shown, what is dropped.
#include "base/assert.h"
#include "runtime/block_mesh_impl.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace crease {

namespace {

// So long a list stays that is not shown, while there is room.
constexpr std::uint32_t kUpdatesOfList = 128;
// By vertex, at which nothing that can be merged is left.
constexpr double kMostErrors = 1e6;

}  // namespace

void BlockMesh::Impl::make_room() {
  const std::uint32_t count = graph.size();
  resident.resize(count);
  runs.resize(count);
  for (auto block = static_cast<std::uint32_t>(bytes_of_block.size()); block < count; ++block) {
    bytes_of_block.push_back(resident_bytes_of(graph.entry(block).facts, *schema));
  }
  more_bytes.resize(count, 0);
  is_refined.resize(count, 0);
  wanted_at.resize(count, 0);
  has_changed = true;
}

BlockChooser::Limits BlockMesh::Impl::limits(const BlockViewParameters& parameters) const {
  const bool has_levels = parameters.in_levels && !parameters.by_vertex;
  return {parameters.max_bytes, bytes_of_block, is_refined, resident,
          has_levels ? &levels : nullptr};
}

BlockUpdate BlockMesh::Impl::update(const BlockViewParameters& given) {
  BlockUpdate report;
  unused.clear();
  BlockViewParameters parameters = given;
  if (!can_see(parameters.view.camera)) {
    if (updates == 0) return report;
    parameters.view.camera = last.view.camera;
  }
  const bool is_same = parameters.view == last.view && parameters.max_bytes == last.max_bytes &&
                       parameters.by_vertex == last.by_vertex &&
                       parameters.in_levels == last.in_levels;
  if (is_same && !has_changed) return report;
  has_changed = false;
  const bool is_limited = is_limited_by_vertex(parameters);
  searches = false;
  if (is_limited && !(parameters.view == last.view && last.by_vertex)) {
    search.look_anew(parameters.view.max_triangles);
  }
  last = parameters;
  ++updates;
  // Before blocks are chosen, so that what levels take counts against the budget at once.
  levels.take_waiting();
  count_resized_levels();
  const double errors = is_limited ? search.trial() : 1;
  const ViewParameters view = is_limited ? with_errors(parameters.view, errors) : parameters.view;
  const std::span<const std::uint32_t> chosen = chooser.choose(view, limits(parameters));
  report.evaluated = chooser.evaluated();
  missing.clear();
  for (const std::uint32_t block : chosen) wanted_at[block] = updates;
  if (chooser.has_all()) {
    could_be.assign(chosen.begin(), chosen.end());
  } else {
    for (const std::uint32_t block : chosen) {
      if (!resident[block]) missing.push_back(graph.entry(block));
    }
    could_be = those_that_can_be(chosen);
  }
  move_cut(is_limited ? those_by_vertex(could_be) : could_be, report);
  const bool have_changed = choose_levels(parameters) || report.refined + report.coarsened > 0;
  drop_beyond(parameters.max_bytes, report);
  if (is_limited) {
    move_within(parameters, have_changed, report);
  } else {
    move_vertices(parameters, have_changed, report);
  }
  find_view_error(view, errors);
  return report;
}

bool BlockMesh::Impl::is_limited_by_vertex(const BlockViewParameters& parameters) {
  return parameters.by_vertex &&
         parameters.view.max_triangles != std::numeric_limits<std::size_t>::max();
}

// Without limits: whatever has errors so many times larger. Exactly that where they are larger, so
// that their number tells how many triangles there are.
ViewParameters BlockMesh::Impl::with_errors(ViewParameters view, double errors) {
  view.camera.pixels *= errors;
  view.degrees *= errors;
  view.max_triangles = std::numeric_limits<std::size_t>::max();
  view.clock = nullptr;
  view.clock_context = nullptr;
  if (errors > 1) view.hysteresis = 1;
  return view;
}

// By vertex with as small errors as the triangles allow.
void BlockMesh::Impl::move_within(const BlockViewParameters& parameters, bool have_changed,
                                  BlockUpdate& report) {
  const std::size_t most = parameters.view.max_triangles;
  BlockViewParameters tried = parameters;
  const bool is_there = graph.pages_added() == page_count && missing.empty() &&
                        std::all_of(could_be.begin(), could_be.end(), [this](std::uint32_t block) {
                          return cuts.hierarchy(block) != nullptr;
                        });
  double errors = search.begin(is_there);
  for (;; errors = ErrorSearch::coarser(errors, triangles(), most)) {
    tried.view = with_errors(parameters.view, errors);
    move_vertices(tried, have_changed, report);
    have_changed = false;
    if (triangles() <= most || errors > kMostErrors) break;
  }
  // What holds the eye is wrong for any error. Those that nothing finer needs are the last ones.
  while (triangles() > most && cut.size() > 1) {
    move_cut({cut.begin(), cut.end() - static_cast<std::ptrdiff_t>((cut.size() + 3) / 4)}, report);
    levels.choose_whole(cut);
    move_vertices(tried, true, report);
  }
  const bool is_complete = is_there && cuts.has_arrived();
  search.tell(errors, triangles(), most, is_complete);
  searches = is_complete && !search.has_ended();
  has_changed |= searches;
}

// By blocks that are not in the cut, and by those that are coarser there than they should be, for
// want of triangles. `view`: with so many times the errors that are allowed.
void BlockMesh::Impl::find_view_error(const ViewParameters& view, double errors) {
  const bool is_limited = !chooser.levels().empty();
  const ViewError error(view, schema->facts.grid);
  view_error = was_by_vertex && is_limited_by_vertex(last) ? search.shown() : 0;
  for (const SeenBlock& wrong : chooser.wrong()) {
    float seen = wrong.error;
    if (is_refined[wrong.block]) {
      const int level = levels.shown(wrong.block);
      if (!is_limited || level == kFullLevel) continue;
      const bool is_known = levels.is_known(wrong.block) && levels.can_choose(wrong.block);
      if (is_known) seen = levels.error_at(wrong.block, level, error);
      if (seen <= 1) continue;
    }
    view_error = std::max(view_error, seen * static_cast<float>(errors));
  }
}

// True if blocks are shown at other levels than before.
bool BlockMesh::Impl::choose_levels(const BlockViewParameters& parameters) {
  missing_levels.clear();
  bool have_changed = false;
  if (!chooser.levels().empty()) {
    have_changed = levels.show_at(cut, chooser.levels(), parameters.view.max_triangles);
    if (parameters.in_levels) levels.list_missing(cut, missing_levels);
  } else if (parameters.by_vertex || !parameters.in_levels) {
    have_changed = levels.choose_whole(cut);
  } else {
    const auto keep = static_cast<float>(1 / std::max(parameters.view.hysteresis, 1.0));
    have_changed = levels.choose(cut, ViewError(parameters.view, schema->facts.grid), keep);
    levels.list_missing(cut, missing_levels);
  }
  const bool are_too_many = resident_bytes > parameters.max_bytes;
  if (are_too_many || updates % kUpdatesOfList == 0) {
    levels.drop_lists(are_too_many ? 0 : kUpdatesOfList);
  }
  count_resized_levels();
  return have_changed;
}

void BlockMesh::Impl::count_resized_levels() {
  for (const std::uint32_t block : levels.take_resized()) count_bytes(block);
}

void BlockMesh::Impl::move_vertices(const BlockViewParameters& parameters, bool have_changed,
                                    BlockUpdate& report) {
  bool lists = have_changed;
  if (parameters.by_vertex) {
    const VertexCuts::Report moved =
        cuts.update({resident, cut, is_refined, is_limited_by_vertex(last)}, parameters.view,
                    lists || !was_by_vertex);
    report.splits += moved.splits;
    report.merges += moved.merges;
    lists |= moved.have_changed;
    has_changed |= !cuts.has_arrived();
    for (const std::uint32_t block : cuts.resized()) count_bytes(block);
    // What has grown beyond the budget is dropped by the next one.
    const bool has_grown = moved.splits + moved.merges > 0 || moved.have_changed;
    has_changed |= has_grown && resident_bytes > parameters.max_bytes;
  } else if (was_by_vertex) {
    cuts.clear();
    lists = true;
    for (std::uint32_t block = 0; block < resident.size(); ++block) count_bytes(block);
  }
  was_by_vertex = parameters.by_vertex;
  if (lists) list_shown();
  if (lists || was_by_vertex) list_cuts();
  list_missing_hierarchies();
}

// Of a resident block, what levels and being by vertex take.
void BlockMesh::Impl::count_bytes(std::uint32_t block) {
  if (!resident[block]) return;
  const std::size_t now = cuts.bytes_of(block) + levels.bytes_of(block);
  resident_bytes = resident_bytes + now - more_bytes[block];
  bytes_of_block[block] = bytes_of_block[block] + now - more_bytes[block];
  more_bytes[block] = now;
}

// Resident, and so is what they need; ascending.
std::vector<std::uint32_t> BlockMesh::Impl::those_that_can_be(
    std::span<const std::uint32_t> chosen) const {
  std::vector<std::uint32_t> next(chosen.begin(), chosen.end());
  std::sort(next.begin(), next.end());
  std::vector<char> will_be(is_refined.size(), 0);
  std::erase_if(next, [&](std::uint32_t block) {
    const std::span<const std::uint32_t> needed = graph.dependencies(block);
    will_be[block] =
        resident[block] != nullptr &&
        std::all_of(needed.begin(), needed.end(), [&](std::uint32_t n) { return will_be[n] != 0; });
    return will_be[block] == 0;
  });
  return next;
}

// Of blocks that can be in the cut, those of which the vertices are known. The base is there in any
// case.
std::vector<std::uint32_t> BlockMesh::Impl::those_by_vertex(std::vector<std::uint32_t> next) const {
  std::vector<char> will_be(is_refined.size(), 0);
  std::erase_if(next, [&](std::uint32_t block) {
    const std::span<const std::uint32_t> needed = graph.dependencies(block);
    will_be[block] =
        cuts.has_vertices(block) &&
        std::all_of(needed.begin(), needed.end(), [&](std::uint32_t n) { return will_be[n] != 0; });
    return will_be[block] == 0 && !graph.is_base(block);
  });
  return next;
}

// `next`: ascending, with all that they need.
void BlockMesh::Impl::move_cut(std::vector<std::uint32_t> next, BlockUpdate& report) {
  if (next == cut) return;
  for (const std::uint32_t block : cut) is_refined[block] = 0;
  for (const std::uint32_t block : next) is_refined[block] = 1;
  std::size_t stay = 0;
  for (std::size_t i = 0, k = 0; i < cut.size() && k < next.size();) {
    stay += cut[i] == next[k];
    const std::uint32_t before = cut[i];
    i += before <= next[k];
    k += next[k] <= before;
  }
  report.refined = next.size() - stay;
  report.coarsened = cut.size() - stay;
  cut = std::move(next);
}

// The one that nobody wanted for longest goes first.
void BlockMesh::Impl::drop_beyond(std::size_t max_bytes, BlockUpdate& report) {
  if (resident_bytes <= max_bytes) return;
  std::vector<std::uint32_t> unwanted;
  for (std::uint32_t block = 0; block < resident.size(); ++block) {
    if (resident[block] && wanted_at[block] != updates) unwanted.push_back(block);
  }
  std::stable_sort(unwanted.begin(), unwanted.end(), [this](std::uint32_t a, std::uint32_t b) {
    return wanted_at[a] < wanted_at[b];
  });
  for (const std::uint32_t block : unwanted) {
    if (resident_bytes <= max_bytes) return;
    CREASE_ASSERT(!is_refined[block]);
    resident_bytes -= resident[block]->bytes() + more_bytes[block];
    more_bytes[block] = 0;  // bytes_of_block still tells what it takes
    cuts.drop(block);
    levels.drop(block);
    runs[block] = {};
    --resident_count;
    unused.push_back(std::exchange(resident[block], nullptr));
    report.dropped.push_back(graph.entry(block).id);
  }
}

// A group is shown unless the block that goes on with it shows something.
bool BlockMesh::Impl::is_shown(std::uint32_t block, std::uint32_t patch) const {
  const std::uint32_t finer = graph.next_finer(graph.entry(block).facts.band, patch);
  return finer == kNone || levels.shown(finer) == 0;
}

// Of what is shown or vanished: what the blocks that would go on from here say of their coarse
// ends.
LevelError BlockMesh::Impl::error_of_cut() const {
  LevelError error;
  const auto add = [&](std::uint32_t block) {
    const LevelError& coarse = graph.entry(block).facts.coarse;
    error = larger(error, is_refined[block] ? levels.left(block, coarse) : coarse);
  };
  for (const std::uint32_t block : graph.starts()) add(block);
  for (const std::uint32_t block : cut) {
    for (const std::uint32_t finer : graph.dependents(block)) add(finer);
  }
  return error;
}

}  // namespace crease

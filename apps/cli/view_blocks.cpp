#include "cli/view_blocks.h"

#include "crease/block_view.h"

#include <algorithm>
#include <utility>

namespace crease::cli {

namespace {

// Of the errors allowed. Until a block is read its worst vertex stands for all of them, and the
// blocks that lead to it get as many splits as that asks for: with those alone that are seen to be
// wrong, up to 60 % more triangles than with the whole file; with those that are wrong by a quarter
// of that, at most a few.
constexpr double kKnownErrors = 0.25;

}  // namespace

std::function<bool(const BlockEntry&)> blocks_for_view(const ModelFacts& facts,
                                                       const ViewParameters& view) {
  ViewParameters known = view;
  known.camera.pixels *= kKnownErrors;
  known.degrees *= kKnownErrors;
  return [known, &facts](const BlockEntry& entry) {
    return needs_block(entry.facts, facts.grid, known);
  };
}

Result<BlockDirectory> BlockDirectory::read(const BlockFile& file) {
  BlockDirectory directory;
  directory.facts_ = file.facts();
  file.source().prefetch(file.head().pages);
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    Result<DirectoryPage> page = file.read_page(p);
    if (!page.ok()) return page.failure();
    directory.pages_.push_back(*std::move(page));
  }
  return directory;
}

std::uint64_t BlockDirectory::triangles_at_most(const ViewParameters& view) const {
  const std::function<bool(const BlockEntry&)> wants = blocks_for_view(facts_, view);
  std::vector<std::vector<char>> is_needed;  // by page
  for (const DirectoryPage& page : pages_) is_needed.emplace_back(page.blocks.size());
  std::uint64_t triangles = 0;
  for (std::size_t p = pages_.size(); p-- > 0;) {  // what a block needs lies before it
    const DirectoryPage& page = pages_[p];
    for (std::size_t i = page.blocks.size(); i-- > 0;) {
      const BlockEntry& entry = page.blocks[i];
      const bool is_base = entry.facts.band == facts_.bands.size();
      if (!is_base && is_needed[p][i] == 0 && !wants(entry)) continue;
      const std::uint32_t fine = entry.facts.triangles_fine;
      triangles += fine - std::min(fine, entry.facts.triangles_coarse);
      for (const BlockId id : page.dependencies_of(entry.id)) {
        is_needed[page_of(id)][index_of(id) % kBlocksPerPage] = 1;
      }
    }
  }
  return triangles;
}

}  // namespace crease::cli

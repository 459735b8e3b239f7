#include "view/session.h"

#include "crease/http_source.h"

#include <algorithm>
#include <utility>

namespace crease {

void Session::open(const std::string& source) {
  leave(opening_, left_openings_);  // the last one named is the one that is wanted
  open_failure_.reset();
  trouble_.clear();
  opening_name_ = source;
  opening_.emplace([source, options = options_, limit = limit_](Note& note) {
    return open_model(source, options, limit, note);
  });
}

bool Session::take_opened() {
  Result<OpenedModel> opened = opening_->take();
  opening_.reset();
  if (!opened.ok()) {
    open_failure_ = opened.failure();
    return false;
  }
  leave(loading_, left_loadings_);
  leave(painting_, left_paintings_);
  close_sides(0);
  data_ = {};
  whole_bytes_ = 0;
  source_ = std::move(opened->source);
  streamer_ = std::make_shared<BlockStreamer>(std::move(opened->streamer));
  materials_ = std::make_shared<GlMaterials>();
  const std::span<const Material> materials = streamer_->mesh().materials();
  wants_textures_ = std::any_of(materials.begin(), materials.end(),
                                [](const Material& m) { return !m.base_color_texture.empty(); });
  texture_trouble_.clear();
  return true;
}

// The last ones first: they share with those before them.
void Session::close_sides(std::size_t count) {
  while (sides_.size() > count) sides_.pop_back();
}

void Session::set_side_count(std::size_t count) {
  if (!streamer_ || sides_.size() == count) return;
  if (loading_ && loading_side_ >= count) leave(loading_, left_loadings_);
  close_sides(count);
  streamer_->set_view_count(count);
  while (sides_.size() < count) {
    const ShownBlocks* beside = sides_.empty() ? nullptr : sides_.front().blocks.get();
    Side side;
    side.blocks = std::make_unique<ShownBlocks>(streamer_, sides_.size(), beside, materials_);
    sides_.push_back(std::move(side));
  }
}

void Session::take_loaded(std::span<ViewSettings> sides, const GlLimits& limits) {
  ViewMode& wanted = sides[loading_side_].mode;
  const auto fall_back = [&](const Failure& failure) {
    trouble_ = failure.message;
    if (wanted == loading_mode_) wanted = ViewMode::Blocks;
  };
  Result<WholeModel> loaded = loading_->take();
  loading_.reset();
  if (!loaded.ok()) return fall_back(loaded.failure());
  whole_bytes_ += loaded->bytes_read;
  data_[std::size_t(loading_mode_)] = loaded->data;
  Result<std::unique_ptr<ShownMesh>> shown = show_whole(*std::move(loaded), limits, materials_);
  if (!shown.ok()) return fall_back(shown.failure());
  sides_[loading_side_].whole[std::size_t(loading_mode_)] = *std::move(shown);
}

void Session::load(std::size_t side, ViewMode mode) {
  loading_side_ = side;
  loading_mode_ = mode;
  trouble_.clear();
  loading_.emplace([source = source_, data = data_[std::size_t(mode)], mode](Note& note) {
    return data.is_there() ? Result<WholeModel>(mesh_of(data)) : load_whole(source, mode, note);
  });
}

// Textures wait until the first cut is there, so that geometry has the line.
void Session::paint(const GlLimits& limits) {
  has_repainted_ = false;
  const auto is_whole = [](const Side& side) { return side.mode != ViewMode::Blocks; };
  const bool has_cut = std::any_of(sides_.begin(), sides_.end(), is_whole) ||
                       (streamer_ && !streamer_->mesh().shown().empty() &&
                        streamer_->statistics().pending_bytes == 0);
  if (wants_textures_ && has_cut) {
    wants_textures_ = false;
    painting_.emplace([source = source_, limit = limit_, most = texture_limits(limits)](
                          Note& note) { return load_textures(source, limit, most, note); });
  }
  if (!painting_ || !painting_->is_done()) return;
  const Result<ModelTextures> loaded = painting_->take();
  painting_.reset();
  if (!loaded.ok()) {
    texture_trouble_ = "textures: " + loaded.failure().message;
    return;
  }
  whole_bytes_ += loaded->bytes_read;
  if (!loaded->textures.notes.empty()) {
    texture_trouble_ = source_.name + ": " + loaded->textures.notes.front();
  }
  if (loaded->textures.empty()) return;
  materials_->fill(loaded->materials, loaded->textures);
  has_repainted_ = true;
}

bool Session::poll(std::span<ViewSettings> sides, const GlLimits& limits) {
  std::erase_if(left_openings_, [](const auto& work) { return work.is_done(); });
  std::erase_if(left_loadings_, [](const auto& work) { return work.is_done(); });
  std::erase_if(left_paintings_, [](const auto& work) { return work.is_done(); });
  const bool is_new = opening_ && opening_->is_done() && take_opened();
  set_side_count(sides.size());
  if (loading_ && loading_->is_done()) take_loaded(sides, limits);
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const ViewMode mode = sides[i].mode;
    const bool is_there = mode == ViewMode::Blocks || sides_[i].whole[std::size_t(mode)] != nullptr;
    if (!is_there && !loading_) load(i, mode);
    sides_[i].mode = is_there ? mode : ViewMode::Blocks;
  }
  paint(limits);
  return is_new;
}

ShownMesh* Session::shown(std::size_t side) const {
  if (side >= sides_.size()) return nullptr;
  const Side& one = sides_[side];
  if (one.mode != ViewMode::Blocks && one.whole[std::size_t(one.mode)]) {
    return one.whole[std::size_t(one.mode)].get();
  }
  return one.blocks.get();
}

const ModelFacts* Session::facts() const {
  return streamer_ ? &streamer_->mesh().facts() : nullptr;
}

std::uint64_t Session::bytes_transferred() const {
  if (!streamer_) return 0;
  return streamer_->statistics().source.bytes_transferred + whole_bytes_;
}

std::uint64_t Session::bytes_read() const {
  const std::uint64_t transferred = bytes_transferred();
  return is_http_url(source_.source) ? transferred : std::min(transferred, source_.bytes);
}

std::optional<Failure> Session::stream_trouble() const {
  if (!streamer_ || !streamer_->trouble()) return std::nullopt;
  Failure trouble = *streamer_->trouble();
  // Sources name themselves, blocks do not.
  if (trouble.message.find(source_.name) == std::string::npos) {
    trouble.message = source_.source + ": " + trouble.message;
  }
  return trouble;
}

std::optional<Failure> Session::stream_failure(std::size_t failed_blocks) const {
  if (!streamer_ || streamer_->statistics().blocks_failed < failed_blocks) {
    return std::nullopt;
  }
  return stream_trouble();
}

void Session::forget_failures() {
  open_failure_.reset();
  trouble_.clear();
  texture_trouble_.clear();
}

std::optional<Message> Session::message() const {
  if (opening_) {
    const Note& note = opening_->note();
    return Message{opening_name_ + ": " + note.stage(), false, note.share()};
  }
  if (open_failure_) return Message{open_failure_->message, true};
  if (loading_) {
    const Note& note = loading_->note();
    return Message{source_.name + ": " + note.stage() + ", by block meanwhile", false,
                   note.share()};
  }
  if (!trouble_.empty()) return Message{trouble_, true};
  if (const std::optional<Failure> trouble = stream_trouble()) {
    return Message{trouble->message, true};
  }
  if (painting_ && streamer_->head().images.bytes > 0) {
    const Note& note = painting_->note();
    return Message{source_.name + ": " + note.stage(), false, note.share()};
  }
  if (!texture_trouble_.empty()) return Message{texture_trouble_, true};
  return std::nullopt;
}

}  // namespace crease

#include "view/session.h"

#include <utility>

namespace crease {

void Session::open(const std::string& source) {
  leave(opening_, left_openings_);  // the last one named is the one that is wanted
  open_failure_.reset();
  trouble_.clear();
  opening_name_ = source;
  opening_.emplace(
      [source, options = options_](Note& note) { return open_model(source, options, note); });
}

bool Session::take_opened() {
  Result<OpenedModel> opened = opening_->take();
  opening_.reset();
  if (!opened.ok()) {
    open_failure_ = opened.failure();
    return false;
  }
  leave(loading_, left_loadings_);
  whole_ = {};
  whole_bytes_ = 0;
  source_ = std::move(opened->source);
  blocks_ = std::make_unique<ShownBlocks>(std::move(opened->streamer));
  return true;
}

void Session::take_loaded(ViewSettings& settings, const GlLimits& limits) {
  const auto fall_back = [&](const Failure& failure) {
    trouble_ = failure.message;
    if (settings.mode == loading_mode_) settings.mode = ViewMode::Blocks;
  };
  Result<WholeModel> loaded = loading_->take();
  loading_.reset();
  if (!loaded.ok()) return fall_back(loaded.failure());
  whole_bytes_ += loaded->bytes_read;
  Result<std::unique_ptr<ShownMesh>> shown = show_whole(*std::move(loaded), limits);
  if (!shown.ok()) return fall_back(shown.failure());
  whole_[std::size_t(loading_mode_)] = *std::move(shown);
}

bool Session::poll(ViewSettings& settings, const GlLimits& limits) {
  std::erase_if(left_openings_, [](const auto& work) { return work.is_done(); });
  std::erase_if(left_loadings_, [](const auto& work) { return work.is_done(); });
  const bool is_new = opening_ && opening_->is_done() && take_opened();
  if (loading_ && loading_->is_done()) take_loaded(settings, limits);
  const bool is_there =
      settings.mode == ViewMode::Blocks || whole_[std::size_t(settings.mode)] != nullptr;
  if (blocks_ && !is_there && !loading_) {
    loading_mode_ = settings.mode;
    trouble_.clear();
    loading_.emplace([source = source_, mode = settings.mode](Note& note) {
      return load_whole(source, mode, note);
    });
  }
  mode_ = is_there ? settings.mode : ViewMode::Blocks;
  return is_new;
}

ShownMesh* Session::shown() const {
  if (mode_ != ViewMode::Blocks && whole_[std::size_t(mode_)]) {
    return whole_[std::size_t(mode_)].get();
  }
  return blocks_.get();
}

const ModelFacts* Session::facts() const {
  return blocks_ ? &blocks_->streamer().mesh().facts() : nullptr;
}

std::span<const std::string> Session::part_names() const {
  if (!blocks_) return {};
  return blocks_->streamer().mesh().part_names();
}

std::uint64_t Session::bytes_read() const {
  if (!blocks_) return 0;
  return blocks_->streamer().statistics().source.bytes_transferred + whole_bytes_;
}

std::optional<Failure> Session::stream_trouble() const {
  if (!blocks_ || !blocks_->streamer().trouble()) return std::nullopt;
  Failure trouble = *blocks_->streamer().trouble();
  // Sources name themselves, blocks do not.
  if (trouble.message.find(source_.name) == std::string::npos) {
    trouble.message = source_.source + ": " + trouble.message;
  }
  return trouble;
}

std::optional<Failure> Session::stream_failure(std::size_t failed_blocks) const {
  if (!blocks_ || blocks_->streamer().statistics().blocks_failed < failed_blocks) {
    return std::nullopt;
  }
  return stream_trouble();
}

void Session::forget_failures() {
  open_failure_.reset();
  trouble_.clear();
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
  return std::nullopt;
}

}  // namespace crease

// The model that is looked at, and the one that is being opened meanwhile.
//
//   session.open("city.crease");
//   every frame:
//     if (session.poll(settings, limits)) camera = ...;   // another model is there
//     for (std::size_t side = 0; side < settings.size(); ++side) {
//       if (ShownMesh* mesh = session.shown(side)) mesh->update(settings[side], camera);
//     }
//
// A picture has one side, or two with a cut each: by block over one stream, else over the same
// arrays.
//
// What is shown stays until there is something to show instead; what fails is told and loses
// nothing.
#pragma once

#include "view/background.h"
#include "view/model_textures.h"
#include "view/open_model.h"
#include "view/settings.h"
#include "view/shown_blocks.h"
#include "view/shown_whole.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crease {

struct Message {
  std::string text;
  bool is_failure = false;
  double share = -1;  // of work that goes on; negative: unknown
};

class Session {
 public:
  explicit Session(const ViewerOptions& options)
      : options_(options), limit_(std::make_shared<RateLimit>(options.max_bytes_per_second)) {}

  void open(const std::string& source);
  // Takes what the background has done, and starts what the modes need; one setting a side. True
  // once when another model is there. Sets a mode back where it cannot be had. A context must be
  // current.
  bool poll(std::span<ViewSettings> sides, const GlLimits& limits);

  // In the mode of the last poll(), or by block while that loads. Null: nothing is open, or there
  // is no such side.
  ShownMesh* shown(std::size_t side = 0) const;
  // The same model by block, whatever is shown.
  const ShownBlocks* blocks(std::size_t side) const {
    return side < sides_.size() ? sides_[side].blocks.get() : nullptr;
  }
  const ModelSource& source() const { return source_; }
  const ModelFacts* facts() const;
  // All that came until now. Of a file here, which is read again for what is whole.
  std::uint64_t bytes_transferred() const;
  // The same from a host; of a file here, how much of it that is.
  std::uint64_t bytes_read() const;
  // What streams may ask for.
  RateLimit& limit() { return *limit_; }

  // What goes on, else what went wrong last.
  std::optional<Message> message() const;
  bool is_busy() const { return opening_ || loading_ || wants_textures_ || painting_; }
  // The last poll() has given the model its textures.
  bool has_repainted() const { return has_repainted_; }
  // Of the last open(), if that failed and nothing was opened since.
  const std::optional<Failure>& failure() const { return open_failure_; }
  // What the stream cannot get over: as many blocks have failed.
  std::optional<Failure> stream_failure(std::size_t failed_blocks) const;
  void forget_failures();

 private:
  struct Side {
    ViewMode mode = ViewMode::Blocks;
    std::unique_ptr<ShownBlocks> blocks;              // null: nothing is open
    std::array<std::unique_ptr<ShownMesh>, 3> whole;  // by mode
  };
  std::optional<Failure> stream_trouble() const;
  bool take_opened();
  void close_sides(std::size_t count);
  void set_side_count(std::size_t count);
  void take_loaded(std::span<ViewSettings> sides, const GlLimits& limits);
  void load(std::size_t side, ViewMode mode);
  void paint(const GlLimits& limits);

  // What nobody wants any more ends when it notices; no frame waits for it.
  template <typename T>
  void leave(std::optional<Background<T>>& work, std::vector<Background<T>>& left) {
    if (!work) return;
    work->stop();
    left.push_back(*std::move(work));
    work.reset();
  }

  const ViewerOptions options_;
  std::vector<Background<OpenedModel>> left_openings_;
  std::vector<Background<WholeModel>> left_loadings_;
  std::optional<Background<OpenedModel>> opening_;
  std::string opening_name_;
  std::vector<Background<ModelTextures>> left_paintings_;
  std::optional<Background<WholeModel>> loading_;
  ViewMode loading_mode_{};
  std::size_t loading_side_ = 0;
  std::uint64_t whole_bytes_ = 0;
  std::optional<Failure> open_failure_;
  std::string trouble_;  // of loading
  std::optional<Background<ModelTextures>> painting_;
  bool wants_textures_ = false;  // which wait for the first cut
  bool has_repainted_ = false;
  std::string texture_trouble_;

  const StreamLimit limit_;
  ModelSource source_;
  std::shared_ptr<BlockStreamer> streamer_;  // a view for each side
  GlMaterialsPtr materials_;                 // of all that show it
  std::array<WholeData, 3> data_;            // by mode: of what is loaded
  std::vector<Side> sides_;                  // one at least while something is open
};

}  // namespace crease

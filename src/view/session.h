// The model that is looked at, and the one that is being opened meanwhile.
//
//   session.open("city.crease");
//   every frame:
//     if (session.poll(settings, limits)) camera = ...;   // another model is there
//     if (ShownMesh* mesh = session.shown()) mesh->update(settings, camera);
//
// What is shown stays until there is something to show instead; what fails is told and loses
// nothing.
#pragma once

#include "view/background.h"
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
  explicit Session(const ViewerOptions& options) : options_(options) {}

  void open(const std::string& source);
  // Takes what the background has done, and starts what `settings.mode` needs. True once when
  // another model is there. Sets the mode back where it cannot be had. A context must be current.
  bool poll(ViewSettings& settings, const GlLimits& limits);

  // In the mode of the last poll(), or by block while that loads. Null: nothing is open.
  ShownMesh* shown() const;
  const ModelSource& source() const { return source_; }
  const ModelFacts* facts() const;
  std::span<const std::string> part_names() const;  // empty while they are not known
  std::uint64_t bytes_read() const;

  // What goes on, else what went wrong last.
  std::optional<Message> message() const;
  bool is_busy() const { return opening_.has_value() || loading_.has_value(); }
  // Of the last open(), if that failed and nothing was opened since.
  const std::optional<Failure>& failure() const { return open_failure_; }
  // What the stream cannot get over: as many blocks have failed.
  std::optional<Failure> stream_failure(std::size_t failed_blocks) const;
  void forget_failures();

 private:
  std::optional<Failure> stream_trouble() const;
  bool take_opened();
  void take_loaded(ViewSettings& settings, const GlLimits& limits);

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
  std::optional<Background<WholeModel>> loading_;
  ViewMode loading_mode_{};
  std::uint64_t whole_bytes_ = 0;
  std::optional<Failure> open_failure_;
  std::string trouble_;  // of loading

  ModelSource source_;
  ViewMode mode_ = ViewMode::Blocks;
  std::unique_ptr<ShownBlocks> blocks_;
  std::array<std::unique_ptr<ShownMesh>, 3> whole_;  // by mode
};

}  // namespace crease

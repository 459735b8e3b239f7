// A model to look at, out of whatever the user names. Takes its time: for threads in the
// background.
#pragma once

#include "crease/async_source.h"
#include "crease/block_file.h"
#include "crease/block_streamer.h"
#include "crease/limited_source.h"
#include "crease/viewer.h"
#include "view/background.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace crease {

struct ModelSource {
  std::string source;                                     // as the user named it
  std::string name;                                       // the last part of it
  std::shared_ptr<const std::vector<std::byte>> built{};  // of a mesh file: its .crease
  std::uint64_t bytes = 0;                                // of the whole .crease
};

struct OpenedModel {
  ModelSource source;
  BlockStreamer streamer;
};

// What streams share, or null.
using StreamLimit = std::shared_ptr<RateLimit>;

// .crease files and URLs are opened, no more; mesh files are read and built. Fails with
// Interrupted soon after the note says to stop.
Result<OpenedModel> open_model(const std::string& source, const ViewerOptions& options,
                               const StreamLimit& limit, Note& note);

// The bytes once more, within what `limit` allows.
Result<AsyncSourcePtr> source_of(const ModelSource& model, const StreamLimit& limit);

// The bytes once more, for loading all of them: reading fails with Interrupted once the note says
// to stop, and tells it how much is read.
Result<BlockFile> open_again(const ModelSource& model, Note& note);

}  // namespace crease

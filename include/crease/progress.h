// What long work tells its caller, and how the caller stops it.
//
//   options.progress = [&](const char* stage, double done) {
//     bar.show(stage, done);
//     return !stop;
//   };
#pragma once

#include <functional>

namespace crease {

// Called now and then from any one thread at a time with the stage's name and the share of it that
// is done (0..1). Returning false asks the work to stop; it then fails with Error::Interrupted.
using ProgressCallback = std::function<bool(const char* stage, double done)>;

}  // namespace crease

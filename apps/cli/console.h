// Standard error, the clock, and Ctrl-C.
//
//   watch_for_interrupts();
//   options.progress = progress_bar(common);     // stops the work after Ctrl-C
//   if (interrupted()) return interrupted_failure();
#pragma once

#include "cli/command.h"
#include "crease/progress.h"

#include <chrono>
#include <cstdint>
#include <string>

namespace crease::cli {

// One line on standard error, unless --quiet.
void log(const Common& common, const std::string& line);

// Draws a bar on standard error when that is a terminal, and asks the work to stop once the user
// has pressed Ctrl-C. Wipes the bar when the last stage is done or another line is logged.
ProgressCallback progress_bar(const Common& common);
void wipe_progress_bar();

// From here on SIGINT and SIGTERM set a flag, so that work ends where it leaves no half file. A
// second one ends the process at once.
void watch_for_interrupts();
bool interrupted();
Failure interrupted_failure();

class Stopwatch {
 public:
  double seconds() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Bytes; the most that the process ever had resident.
std::uint64_t peak_memory();

}  // namespace crease::cli

#include "cli/console.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace crease::cli {

namespace {

volatile std::sig_atomic_t interrupt_count = 0;
bool bar_is_drawn = false;

void on_interrupt(int signal) {
  interrupt_count = interrupt_count + 1;
  std::signal(signal, SIG_DFL);  // the second time the system ends us
}

}  // namespace

void wipe_progress_bar() {
  if (!bar_is_drawn) return;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  bar_is_drawn = false;
}

void log(const Common& common, const std::string& line) {
  if (common.quiet) return;
  wipe_progress_bar();
  std::fprintf(stderr, "%s\n", line.c_str());
}

ProgressCallback progress_bar(const Common& common) {
  const bool drawn = !common.quiet && isatty(STDERR_FILENO) != 0;
  int shown_percent = -1;
  std::string shown_stage;
  return [drawn, shown_percent, shown_stage](const char* stage, double done) mutable {
    const int percent = static_cast<int>(100 * std::clamp(done, 0.0, 1.0));
    if (drawn && (percent != shown_percent || shown_stage != stage)) {
      constexpr int kWidth = 30;
      const int filled = percent * kWidth / 100;
      const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                              std::string(static_cast<std::size_t>(kWidth - filled), '.');
      std::fprintf(stderr, "\r%-12s [%s] %3d %%\033[K", stage, bar.c_str(), percent);
      std::fflush(stderr);
      bar_is_drawn = true;
      shown_percent = percent;
      shown_stage = stage;
    }
    return !interrupted();
  };
}

void watch_for_interrupts() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() {
  return interrupt_count > 0;
}

Failure interrupted_failure() {
  return fail(Error::Interrupted, "interrupted; nothing was written");
}

double Stopwatch::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace crease::cli

// The last frames' numbers, for graphs.
#pragma once

#include "view/settings.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace crease {

inline constexpr std::size_t kHistoryLength = 240;

enum class Series { FrameMs, UploadKb, ResidentMb, PendingKb, StreamedKb, ErrorPixels };
inline constexpr std::size_t kSeriesCount = 6;

class Histories {
 public:
  void add(double frame_ms, const FrameFacts& facts);

  struct View {
    std::span<const float> values;  // a ring
    std::size_t oldest = 0;
    float last = 0, largest = 0;
  };
  View of(Series series) const;

  std::size_t frame_count() const { return frame_count_; }
  double median_frame_ms() const;  // of all frames, or the last so many; 0 without any
  static constexpr std::size_t kMostFrames = std::size_t(1) << 20;

 private:
  std::array<std::array<float, kHistoryLength>, kSeriesCount> rings_{};
  std::size_t next_ = 0;
  std::vector<float> frame_ms_;  // a ring, once it is full
  std::size_t frame_count_ = 0;
};

// How fast a count grows, over the last second.
class Pace {
 public:
  // `now`: seconds of any clock, ascending. A count that falls begins anew.
  double add(double now, std::uint64_t count);

 private:
  struct Entry {
    double time;
    std::uint64_t count;
  };
  std::deque<Entry> entries_;
};

}  // namespace crease

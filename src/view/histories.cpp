#include "view/histories.h"

#include <algorithm>

namespace crease {

void Histories::add(double frame_ms, const FrameFacts& facts) {
  const std::array<double, kSeriesCount> values{frame_ms,
                                                double(facts.uploaded_bytes) / 1e3,
                                                double(facts.resident_bytes) / 1e6,
                                                double(facts.pending_bytes) / 1e3,
                                                facts.bytes_per_second / 1e3,
                                                facts.error_pixels};
  for (std::size_t i = 0; i < kSeriesCount; ++i) rings_[i][next_] = float(values[i]);
  next_ = (next_ + 1) % kHistoryLength;
  if (frame_ms_.size() < kMostFrames) {
    frame_ms_.push_back(float(frame_ms));
  } else {
    frame_ms_[frame_count_ % kMostFrames] = float(frame_ms);
  }
  ++frame_count_;
}

Histories::View Histories::of(Series series) const {
  const auto& ring = rings_[std::size_t(series)];
  return {ring, next_, ring[(next_ + kHistoryLength - 1) % kHistoryLength],
          *std::max_element(ring.begin(), ring.end())};
}

double Histories::median_frame_ms() const {
  if (frame_ms_.empty()) return 0;
  std::vector<float> sorted = frame_ms_;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return double(*middle);
}

double Pace::add(double now, std::uint64_t count) {
  constexpr double kSeconds = 1;
  if (!entries_.empty() && count < entries_.back().count) entries_.clear();
  entries_.push_back({now, count});
  while (entries_.size() > 2 && entries_[1].time <= now - kSeconds) entries_.pop_front();
  const Entry& first = entries_.front();
  return double(count - first.count) / std::max(kSeconds, now - first.time);
}

}  // namespace crease

// Many measurements of one thing.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace crease::bench {

class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  // 0.5: the median, 1: the largest. There must be some.
  double of(double share) {
    std::ranges::sort(values_);
    return values_[std::min(values_.size() - 1, std::size_t(share * double(values_.size())))];
  }

 private:
  std::vector<double> values_;
};

}  // namespace crease::bench

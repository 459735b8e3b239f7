// A list that is filled anew again and again: its memory stays, and nothing of it is cleared.
#pragma once

#include <cstddef>
#include <vector>

namespace crease::simplification {

template <class T>
class ScratchList {
 public:
  // Empty, with room for `most` from begin() on; finish() tells where the list ends.
  T* start(std::size_t most) {
    if (values_.size() < most) values_.resize(2 * most);
    count_ = 0;
    return values_.data();
  }
  void finish(const T* end) { count_ = static_cast<std::size_t>(end - values_.data()); }

  bool empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }
  T* begin() { return values_.data(); }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + count_; }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::vector<T> values_;
  std::size_t count_ = 0;
};

// Empties `values`, with room for `most`: somewhat more, since the next patch is as large but for a
// few, and arrays that move for those few leave holes in memory.
template <class T>
void clear_for(std::vector<T>& values, std::size_t most) {
  values.clear();
  if (values.capacity() >= most) return;
  values.shrink_to_fit();  // first let go of the old room
  values.reserve(most + most / 8);
}

}  // namespace crease::simplification

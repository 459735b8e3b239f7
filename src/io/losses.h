// What materials lose when they are read, for the notes of an import.
//
//   Losses losses;
//   losses.add("emission", emits);   // once a material
//   losses.notes();                  // "2 materials lose emission"
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace crease {

// How many materials lose a thing, by its name, in the order of the first.
class Losses {
 public:
  void add(const std::string& what, bool is_lost) {
    if (!is_lost) return;
    const auto found = std::ranges::find(counts_, what, &Count::first);
    if (found != counts_.end()) {
      ++found->second;
    } else if (counts_.size() < kMostNames) {
      counts_.emplace_back(what, 1);
    }
  }
  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    for (const auto& [what, count] : counts_) {
      notes.push_back(count == 1 ? "a material loses " + what
                                 : std::to_string(count) + " materials lose " + what);
    }
    return notes;
  }

 private:
  static constexpr std::size_t kMostNames = 32;  // extensions have any
  using Count = std::pair<std::string, std::size_t>;
  std::vector<Count> counts_;
};

}  // namespace crease

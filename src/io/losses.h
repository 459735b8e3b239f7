// What materials lose when they are read, for the notes of an import.
//
//   Losses losses;
//   losses.add("emission", emits);   // once a material
//   losses.add_shown_emission();     // once a material that shows it as its base colour
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
  void add_shown_emission() { ++shown_emissions_; }
  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    for (const auto& [what, count] : counts_) {
      notes.push_back(count == 1 ? "a material loses " + what
                                 : std::to_string(count) + " materials lose " + what);
    }
    if (shown_emissions_ > 0) {
      notes.push_back((shown_emissions_ == 1
                           ? "a material is"
                           : std::to_string(shown_emissions_) + " materials are") +
                      std::string(" black but for emission, which becomes the base colour"));
    }
    return notes;
  }

 private:
  static constexpr std::size_t kMostNames = 32;  // extensions have any
  using Count = std::pair<std::string, std::size_t>;
  std::vector<Count> counts_;
  std::size_t shown_emissions_ = 0;
};

}  // namespace crease

// Per key a range of items, for keys that nearly all have the ordinary number of them.
//
//   RankedBits bits(flags);                 bits.rank(i): how many are set before i
//   CompactRanges around(counts, 2);        around.begin(k), around.count(k): 2 items is ordinary
//   SparseLists<float> lists;               lists.push_back(items), then lists.of(k): most are
//   empty
//
// A key that is ordinary costs 1.5 bits, another one 4 bytes on top. Everything is O(1).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// std::popcount() calls a function where the processor may lack the instruction.
constexpr std::uint32_t popcount_inline(std::uint64_t bits) {
#if defined(__POPCNT__) || !defined(__x86_64__)
  return static_cast<std::uint32_t>(std::popcount(bits));
#else
  bits -= bits >> 1 & 0x5555555555555555u;
  bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu;
  return static_cast<std::uint32_t>(bits * 0x0101010101010101u >> 56);
#endif
}

// A bit per key, and how many of them are set before it: side by side, so that both are one
// look-up.
class RankedBits {
 public:
  void push_back(bool bit) {
    if (size_ % 64 == 0) words_.push_back({0, 0, set_count_});
    Word& word = words_.back();
    (size_ % 64 < 32 ? word.low : word.high) |= std::uint32_t(bit) << (size_ % 32);
    set_count_ += bit ? 1 : 0;
    ++size_;
  }
  bool test(std::size_t key) const { return (words_[key / 64].bits() >> (key % 64) & 1) != 0; }
  std::uint32_t rank(std::size_t key) const {
    const Word& word = words_[key / 64];
    const std::uint64_t before = word.bits() & ((std::uint64_t(1) << (key % 64)) - 1);
    return word.rank + popcount_inline(before);
  }
  void prefetch(std::size_t key) const { __builtin_prefetch(&words_[key / 64]); }
  std::size_t size() const { return size_; }
  std::size_t set_count() const { return set_count_; }
  std::size_t bytes() const { return sizeof(Word) * words_.size(); }

 private:
  struct Word {
    std::uint32_t low, high;
    std::uint32_t rank;  // of its first key

    std::uint64_t bits() const { return std::uint64_t(high) << 32 | low; }
  };
  std::vector<Word> words_;
  std::size_t size_ = 0;
  std::uint32_t set_count_ = 0;
};

// The ranges of all keys, one after the other. A key's begin is `usual` times the key, plus what
// the unusual keys before it have in excess (modulo 2^32).
class CompactRanges {
 public:
  explicit CompactRanges(std::uint32_t usual = 1) : usual_(usual) {}

  void push_back(std::uint32_t count) {
    is_unusual_.push_back(count != usual_);
    if (count != usual_) excess_.push_back(excess_.back() + (count - usual_));
  }
  std::uint32_t begin(std::size_t key) const {
    return static_cast<std::uint32_t>(key) * usual_ + excess_[is_unusual_.rank(key)];
  }
  std::uint32_t count(std::size_t key) const {
    if (!is_unusual_.test(key)) return usual_;
    const std::uint32_t rank = is_unusual_.rank(key);
    return usual_ + (excess_[rank + 1] - excess_[rank]);
  }
  std::uint32_t end(std::size_t key) const { return begin(key) + count(key); }
  struct Range {
    std::uint32_t begin, end;
  };
  Range range(std::size_t key) const {  // begin and end for one look-up
    const std::uint32_t rank = is_unusual_.rank(key), before = excess_[rank];
    const std::uint32_t begin = static_cast<std::uint32_t>(key) * usual_ + before;
    if (!is_unusual_.test(key)) return {begin, begin + usual_};
    return {begin, begin + usual_ + (excess_[rank + 1] - before)};
  }
  // Of this key and of the next one.
  std::array<Range, 2> two_ranges(std::size_t key) const {
    std::uint32_t rank = is_unusual_.rank(key);
    std::uint32_t begin = static_cast<std::uint32_t>(key) * usual_ + excess_[rank];
    std::array<Range, 2> found;
    for (std::size_t i = 0; i < 2; ++i) {
      found[i] = {begin, begin + usual_};
      if (is_unusual_.test(key + i)) {
        found[i].end += excess_[rank + 1] - excess_[rank];
        ++rank;
      }
      begin = found[i].end;
    }
    return found;
  }
  bool is_usual(std::size_t key) const { return !is_unusual_.test(key); }
  // And how many items the unusual keys before this one have.
  struct RangeAmongUnusual {
    Range range;
    std::uint32_t unusual_before;
  };
  RangeAmongUnusual range_among_unusual(std::size_t key) const {
    const std::uint32_t rank = is_unusual_.rank(key), before = excess_[rank];
    const std::uint32_t begin = static_cast<std::uint32_t>(key) * usual_ + before;
    const std::uint32_t more = is_unusual_.test(key) ? excess_[rank + 1] - before : 0;
    return {{begin, begin + usual_ + more}, rank * usual_ + before};
  }
  std::uint32_t total() const {
    return static_cast<std::uint32_t>(size()) * usual_ + excess_.back();
  }
  void prefetch(std::size_t key) const { is_unusual_.prefetch(key); }
  // What is left to be read then.
  void prefetch_further(std::size_t key) const {
    __builtin_prefetch(&excess_[is_unusual_.rank(key)]);
  }
  std::size_t size() const { return is_unusual_.size(); }
  std::size_t bytes() const { return is_unusual_.bytes() + 4 * excess_.size(); }

 private:
  std::uint32_t usual_;
  RankedBits is_unusual_;
  std::vector<std::uint32_t> excess_{
      0};  // before the first unusual key, after it, after the second
};

// A list of items per key. An empty one costs 1.5 bits.
template <typename Item>
class SparseLists {
 public:
  void push_back(std::span<const Item> items) {
    has_items_.push_back(!items.empty());
    if (items.empty()) return;
    items_.insert(items_.end(), items.begin(), items.end());
    end_.push_back(static_cast<std::uint32_t>(items_.size()));
  }
  std::span<const Item> of(std::size_t key) const {
    if (!has_items_.test(key)) return {};
    const std::uint32_t rank = has_items_.rank(key);
    return std::span<const Item>(items_).subspan(end_[rank], end_[rank + 1] - end_[rank]);
  }
  std::size_t size() const { return has_items_.size(); }
  std::size_t list_count() const { return has_items_.set_count(); }
  std::size_t item_count() const { return items_.size(); }
  std::size_t bytes() const {
    return has_items_.bytes() + 4 * end_.size() + sizeof(Item) * items_.size();
  }

 private:
  RankedBits has_items_;
  std::vector<std::uint32_t> end_{0};
  std::vector<Item> items_;
};

}  // namespace crease

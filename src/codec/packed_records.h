// Rows of a few integers each for keeping: every column in as many bits as its values are apart.
//
//   PackedRecords<3> places(positions.size(), [&](std::size_t i) { return ...; });
//   places[i]
//
// A read is two loads and three shifts a column.
#pragma once

#include "crease/packed_indices.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

template <std::size_t kColumns>
class PackedRecords {
 public:
  using Record = std::array<std::uint32_t, kColumns>;  // signed ones as their bits

  PackedRecords() = default;
  // `record_of(i)` is called twice for each of `count`. Signed values that are on both sides of
  // zero take 32 bits, unless their columns are said to be so.
  template <typename RecordOf>
  PackedRecords(std::size_t count, RecordOf record_of, bool is_signed = false)
      : size_(count), flip_(is_signed ? 0x80000000u : 0) {
    if (count == 0) return;
    Record high{};
    low_.fill(0xffffffffu);
    for (std::size_t i = 0; i < count; ++i) {
      const Record record = record_of(i);
      for (std::size_t k = 0; k < kColumns; ++k) {
        low_[k] = std::min(low_[k], record[k] ^ flip_);
        high[k] = std::max(high[k], record[k] ^ flip_);
      }
    }
    for (std::size_t k = 0; k < kColumns; ++k) {
      bits_[k] = static_cast<std::uint8_t>(std::bit_width(high[k] - low_[k]));
      bits_of_record_ += bits_[k];
    }
    packed_.reserve(count * bits_of_record_);
    for (std::size_t i = 0; i < count; ++i) {
      const Record record = record_of(i);
      for (std::size_t k = 0; k < kColumns; ++k) {
        packed_.append((record[k] ^ flip_) - low_[k], bits_[k]);
      }
    }
  }

  Record operator[](std::size_t i) const {
    Record record;
    std::size_t bit = i * bits_of_record_;
    for (std::size_t k = 0; k < kColumns; ++k) {
      record[k] = (packed_.read(bit, bits_[k]) + low_[k]) ^ flip_;
      bit += bits_[k];
    }
    return record;
  }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return packed_.bytes(); }  // beside the object

 private:
  BitArray packed_;
  std::size_t size_ = 0, bits_of_record_ = 0;
  std::uint32_t flip_ = 0;  // makes the order of signed values that of unsigned ones
  Record low_{};
  std::array<std::uint8_t, kColumns> bits_{};
};

// The same, of which many are equal: each once, and numbers.
template <std::size_t kColumns>
class RepeatedRecords {
 public:
  using Record = typename PackedRecords<kColumns>::Record;

  RepeatedRecords() = default;
  template <typename RecordOf>
  RepeatedRecords(std::size_t count, RecordOf record_of, bool is_signed = false) {
    constexpr std::uint32_t kFree = 0xffffffffu;
    std::vector<Record> different;
    std::vector<std::uint32_t> which(count);
    std::vector<std::uint32_t> table(std::bit_ceil(2 * count + 1), kFree);
    for (std::size_t i = 0; i < count; ++i) {
      const Record record = record_of(i);
      std::uint64_t hash = 0;
      for (const std::uint32_t column : record) {
        hash = (hash ^ column) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
      }
      std::size_t place = hash & (table.size() - 1);
      while (table[place] != kFree && different[table[place]] != record) {
        place = (place + 1) & (table.size() - 1);
      }
      if (table[place] == kFree) {
        table[place] = static_cast<std::uint32_t>(different.size());
        different.push_back(record);
      }
      which[i] = table[place];
    }
    values_ = PackedRecords<kColumns>(
        different.size(), [&](std::size_t i) { return different[i]; }, is_signed);
    which_ = PackedRecords<1>(
        count, [&](std::size_t i) { return typename PackedRecords<1>::Record{which[i]}; });
  }

  Record operator[](std::size_t i) const { return values_[which_[i][0]]; }
  std::size_t size() const { return which_.size(); }
  std::size_t bytes() const { return values_.bytes() + which_.bytes(); }

 private:
  PackedRecords<kColumns> values_;
  PackedRecords<1> which_;
};

}  // namespace crease::codec

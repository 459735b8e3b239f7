#include "plain_decoder/names.h"

#include "plain_decoder/arithmetic.h"
#include "plain_decoder/bits.h"

#include <algorithm>
#include <array>
#include <map>

namespace plain {

namespace {

class NameReader {
 public:
  explicit NameReader(std::span<const std::byte> bytes) : in_(bytes) {}

  std::string next(std::uint64_t most) {
    const std::uint32_t length =
        static_cast<std::uint32_t>(before_.size()) + static_cast<std::uint32_t>(length_.read(in_));
    demand(length <= most, "a name that is too long");
    const std::uint32_t shared = shared_before_ + static_cast<std::uint32_t>(shared_.read(in_));
    demand(shared <= std::min<std::size_t>(length, before_.size()),
           "more than the name before has");
    std::string name = before_.substr(0, shared);
    while (name.size() < length) name += letter(name, name.size() == shared);
    shared_before_ = shared;
    return before_ = name;
  }

  bool is_at_end() const { return in_.is_at_end(); }

 private:
  char letter(const std::string& name, bool is_first) {
    const auto of = [](char c) { return std::uint32_t(static_cast<unsigned char>(c)); };
    const auto back = [&](std::size_t i) {
      return i <= name.size() ? of(name[name.size() - i]) : 0;
    };
    const std::uint32_t above = name.size() < before_.size() ? of(before_[name.size()]) : 0;
    const std::uint32_t contexts[3] = {
        256 * back(2) + back(1),
        (1u << 24) * back(4) + (1u << 16) * back(3) + 256 * back(2) + back(1),
        512 * back(1) + 2 * above + (is_first ? 1 : 0)};
    std::uint32_t node = 1;
    while (node < 256) {
      std::vector<AdaptiveBit*> bits;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t sum = contexts[c] * 2'654'435'761u + node * 2'246'822'507u;
        bits.push_back(&tables_[{c, sum >> 16}]);
      }
      node = 2 * node + read_mixed(in_, bits, weights_[is_first]);
    }
    return static_cast<char>(node - 256);
  }

  RangeDecoder in_;
  std::string before_;
  std::uint32_t shared_before_ = 0;
  Signed length_, shared_;
  BitsBy<2> tables_;
  std::array<Weights, 2> weights_;
};

}  // namespace

std::vector<std::string> read_names(std::span<const std::byte> bytes, std::uint32_t count,
                                    std::uint64_t letters) {
  NameReader reader(bytes);
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < count; ++i) {
    names.push_back(reader.next(letters));
    letters -= names.back().size();
  }
  demand(letters == 0 && reader.is_at_end(), "names that do not end with their bytes");
  return names;
}

}  // namespace plain

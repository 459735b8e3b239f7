#include "plain_decoder/entries.h"

#include "plain_decoder/arithmetic.h"

#include <algorithm>
#include <bit>

namespace plain {

Errors ErrorsReader::read(RangeDecoder& in) {
  Errors errors{};
  for (std::size_t k = 0; k < 4; ++k) {
    Kind& kind = kinds_[k];
    kind.was_zero = kind.is_zero[kind.was_zero].read(in);
    if (kind.was_zero) continue;
    kind.last += static_cast<std::uint32_t>(kind.difference.read(in));
    demand(kind.last <= 0xfeff, "an error that is none");
    errors[k] = std::bit_cast<float>(kind.last << 15);
  }
  return errors;
}

std::vector<Band> read_bands(std::span<const std::byte> bytes, std::size_t count,
                             std::uint64_t triangles) {
  RangeDecoder in(bytes);
  Signed patches, triangles_low, contractions_low;
  Magnitude triangles_high, contractions_high;
  ErrorsReader errors;
  std::vector<Band> bands;
  const auto number = [&in](Magnitude& high, Signed& low, std::uint64_t expected) {
    const std::uint64_t upper = high.read(in);
    return upper << 32 | static_cast<std::uint32_t>(static_cast<std::uint32_t>(expected) +
                                                    static_cast<std::uint32_t>(low.read(in)));
  };
  while (bands.size() < count) {
    Band band;
    const std::uint32_t before = bands.empty() ? 0 : bands.back().patches;
    band.patches = before / 2 + static_cast<std::uint32_t>(patches.read(in));
    band.triangles_after = number(triangles_high, triangles_low, triangles / 2);
    band.contractions =
        number(contractions_high, contractions_low, (triangles - band.triangles_after) / 2);
    band.errors = errors.read(in);
    triangles = band.triangles_after;
    bands.push_back(band);
  }
  demand(in.is_at_end(), "bytes behind the bands");
  return bands;
}

EntryReader::EntryReader(std::span<const std::byte> bytes, const Head& head)
    : in_(bytes), layers_(static_cast<std::uint32_t>(head.layers.size())) {
  before_.band = static_cast<std::uint16_t>(head.bands.size());
}

Entry EntryReader::entry() {
  Entry e;
  const std::uint32_t band = after(band_, before_.band);
  demand(band <= 0xffff, "a band that there is none of");
  e.band = static_cast<std::uint16_t>(band);
  e.patch = after(patch_, has_before_ && e.band == before_.band ? before_.patch + 1 : 0);
  has_before_ = true;
  e.splits = after(splits_, before_.splits);
  e.coarse_triangles = after(coarse_triangles_, before_.coarse_triangles);
  e.fine_triangles =
      after(fine_triangles_, before_.fine_triangles + (e.coarse_triangles + 2 * e.splits) -
                                 (before_.coarse_triangles + 2 * before_.splits));
  e.vertices =
      after(vertices_, before_.vertices + e.fine_triangles / 2 - before_.fine_triangles / 2);
  e.memory = after(memory_,
                   4096 + 400 * (e.vertices + e.fine_triangles) + 160 * layers_ * e.fine_triangles);
  const std::uint64_t splits = std::max(e.splits, 1u), others = std::max(before_.splits, 1u);
  e.bytes = after(bytes_, static_cast<std::uint32_t>(before_.bytes * splits / others));
  sphere(e);
  e.coarse = coarse_.read(in_);
  e.fine = fine_.read(in_);
  for (std::size_t k = 0; k < 4; ++k) {
    demand(e.fine[k] <= e.coarse[k], "a fine end that has the greater error");
  }
  before_ = e;
  return e;
}

std::vector<std::uint32_t> EntryReader::dependencies(std::uint32_t id) {
  std::vector<std::uint32_t> needs;
  const std::uint32_t count = count_.read(in_);
  for (std::uint32_t d = 0; d < count; ++d) {
    std::uint32_t needed = 0;
    if (d == 0) {
      needed = first_dependency_ = after(first_, first_dependency_);
    } else {
      needed = needs.back() + 1 + gap_.read(in_);
      demand(needs.back() < needed, "needed blocks that do not ascend");
    }
    demand(needed < id, "a block that needs one that is not before it");
    needs.push_back(needed);
  }
  return needs;
}

std::uint32_t EntryReader::after(Signed& model, std::uint32_t expected) {
  return expected + static_cast<std::uint32_t>(model.read(in_));
}

void EntryReader::sphere(Entry& e) {
  radius_code_ = after(radius_, radius_code_);
  demand(radius_code_ <= 3327, "a radius that is none");
  const std::uint32_t zeros = radius_code_ < 256 ? 0 : radius_code_ / 128 - 1;
  e.radius = (radius_code_ - 128 * zeros) << zeros;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto expected = static_cast<std::uint32_t>(before_.centre.along(k) >> zeros);
    e.centre.along(k) = static_cast<std::int32_t>(after(centre_[k], expected) << zeros);
  }
}

}  // namespace plain

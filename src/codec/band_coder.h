// What the head says of bands, from fine to coarse (docs/format.md, "Bands"). One body for both
// directions, as coded_numbers.h.
#pragma once

#include "codec/coded_numbers.h"
#include "codec/errors_model.h"
#include "crease/block_file.h"

#include <cstdint>

namespace crease::codec {

template <class Coder>
class BandCoder {
 public:
  BandCoder(Coder& coder, std::uint64_t triangle_count)
      : coder_(coder), triangles_before_(triangle_count) {}

  // The next coarser one. Its error is rounded up.
  BandFacts code(const BandFacts& band) {
    BandFacts coded;
    coded.patches = code_after(coder_, patches_, band.patches, patches_before_ / 2);
    coded.triangles_after = code_number(triangles_, band.triangles_after, triangles_before_ / 2);
    // Most contractions take two triangles.
    const std::uint64_t fewer = triangles_before_ - coded.triangles_after;
    coded.contractions = code_number(contractions_, band.contractions, fewer / 2);
    coded.error = errors_.code(coder_, band.error);
    patches_before_ = coded.patches;
    triangles_before_ = coded.triangles_after;
    return coded;
  }

  bool failed() const { return coder_.failed() || errors_.failed(); }

 private:
  struct NumberModel {
    MagnitudeModel high;
    SignedModel low;
  };

  std::uint64_t code_number(NumberModel& model, std::uint64_t value, std::uint64_t expected) {
    const std::uint64_t high =
        code_magnitude(coder_, model.high, static_cast<std::uint32_t>(value >> 32));
    return high << 32 | code_after(coder_, model.low, static_cast<std::uint32_t>(value),
                                   static_cast<std::uint32_t>(expected));
  }

  Coder& coder_;
  std::uint32_t patches_before_ = 0;
  std::uint64_t triangles_before_;
  SignedModel patches_;
  NumberModel triangles_, contractions_;
  ErrorsModel errors_;
};

}  // namespace crease::codec

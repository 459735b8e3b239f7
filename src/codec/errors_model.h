// The four errors of one end after another: codes of 16 bits, rounded up (docs/format.md,
// "Errors"). One body for both directions, as coded_numbers.h.
#pragma once

#include "codec/coded_numbers.h"
#include "codec/container.h"
#include "crease/contraction.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace crease::codec {

class ErrorsModel {
 public:
  // Of what the encoder is given, what a file can say: no less, and above it by less than 0.4 %.
  template <class Coder>
  LevelError code(Coder& coder, const LevelError& errors) {
    LevelError coded;
    coded.surface = code(coder, kinds_[0], errors.surface);
    coded.line = code(coder, kinds_[1], errors.line);
    coded.degrees = code(coder, kinds_[2], errors.degrees);
    coded.texture = code(coder, kinds_[3], errors.texture);
    return coded;
  }

  // A code came that stands for no error.
  bool failed() const { return is_wrong_; }

 private:
  struct Kind {
    std::array<AdaptiveBit, 2> is_zero;  // by whether the last one was
    SignedModel difference;
    bool was_zero = true;
    std::uint32_t last = 0;  // that was not
  };

  template <class Coder>
  float code(Coder& coder, Kind& kind, float error) {
    const std::uint32_t code = format::code_of_error(error);
    kind.was_zero = coder.bit(kind.is_zero[kind.was_zero], code == 0);
    if (kind.was_zero) return 0;
    const std::uint32_t coded = code_after(coder, kind.difference, code, kind.last);
    is_wrong_ |= coded > format::kMaxErrorCode;
    kind.last = std::min<std::uint32_t>(coded, format::kMaxErrorCode);
    return format::error_of_code(static_cast<std::uint16_t>(kind.last));
  }

  std::array<Kind, 4> kinds_;
  bool is_wrong_ = false;
};

}  // namespace crease::codec

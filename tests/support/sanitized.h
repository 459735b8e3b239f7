// Whether a sanitizer watches, which takes up to twenty times as long: such builds try every
// property on fewer and smaller models, since what they look for does not depend on size.
#pragma once

#include "base/sanitizer.h"

namespace crease {

#if defined(CREASE_ADDRESS_SANITIZER) || defined(CREASE_THREAD_SANITIZER)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace crease

// Whether a sanitizer watches, which takes up to twenty times as long: such builds try every
// property on fewer and smaller models, since what they look for does not depend on size.
#pragma once

#include "base/sanitizer.h"

#include <cstddef>

namespace crease {

#if defined(CREASE_ADDRESS_SANITIZER) || defined(CREASE_THREAD_SANITIZER)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// Of all bits or lengths of a file every how many are harmed. Coprime to 8, so that each place in a
// byte has its turn; the fuzzers harm the rest.
inline constexpr std::size_t kHarmStep = kSanitized ? 11 : 1;

}  // namespace crease

// Whether a sanitizer watches, which takes up to twenty times as long: such builds try every
// property on fewer and smaller models, since what they look for does not depend on size.
#pragma once

namespace crease {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace crease

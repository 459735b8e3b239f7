// CREASE_ADDRESS_SANITIZER, CREASE_THREAD_SANITIZER: defined where one watches, as GCC and as clang
// say so.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define CREASE_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CREASE_ADDRESS_SANITIZER
#endif
#endif

#if defined(__SANITIZE_THREAD__)
#define CREASE_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define CREASE_THREAD_SANITIZER
#endif
#endif

// A broken promise inside the program. Active in every build: the checks are cheap ones.
#pragma once

#include <cstdio>
#include <cstdlib>

#define CREASE_ASSERT(condition)                                                           \
  do {                                                                                     \
    if (!(condition)) {                                                                    \
      std::fprintf(stderr, "%s:%d: broken promise: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                        \
    }                                                                                      \
  } while (false)

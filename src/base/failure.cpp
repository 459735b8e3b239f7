#include "crease/result.h"

#include <cstdio>
#include <cstdlib>

// The exit status and the names of errors live with the command line; the library only carries
// codes.
namespace crease {

static_assert(static_cast<int>(Error::Truncated) == 22 && static_cast<int>(Error::Invalid) == 50);

void end_without_value(const Failure& failure) {
  std::fprintf(stderr, "broken promise: the value of a Result that failed: %s\n",
               failure.message.c_str());
  std::abort();
}

void end_without_failure() {
  std::fprintf(stderr, "broken promise: the failure of a Result that is ok\n");
  std::abort();
}

}  // namespace crease

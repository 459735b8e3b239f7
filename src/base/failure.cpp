#include "crease/result.h"

// The exit status and the names of errors live with the command line; the library only carries
// codes. This file makes the folder a library and holds the promise that codes stay as they are.
namespace crease {
static_assert(static_cast<int>(Error::Truncated) == 22 && static_cast<int>(Error::Invalid) == 50);
}  // namespace crease

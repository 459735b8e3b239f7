// The halves that the viewer begins with.
#pragma once

#include "view/settings.h"

namespace crease {

SplitSettings split_of(const ViewerOptions& options);

}  // namespace crease

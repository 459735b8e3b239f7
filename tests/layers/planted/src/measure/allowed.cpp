#include <embree3/rtcore.h>
#include "base/words.h"
#include "crease/words.h"

#include <embree3/rtcore.h>
#include "crease/compare.h"
#include "encode_block.h"

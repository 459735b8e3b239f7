#include "codec/ring.h"

#include "codec/ring.h"
#include "plain_decoder/bits.h"
#include "plain_decoder/difference_test.h"

#include <vector>
#include <xxhash.h>

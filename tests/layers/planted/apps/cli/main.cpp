#include "codec/decode_block.h"
#include "cli/own.h"
#include "crease/words.h"

#include "codec/encode_block.h"

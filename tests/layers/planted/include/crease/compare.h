#include <crease/words.h>

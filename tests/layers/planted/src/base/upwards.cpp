#include "measure/tree.h"  // upwards

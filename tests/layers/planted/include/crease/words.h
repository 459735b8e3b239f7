#include "base/private.h"
#include <nlohmann/json.hpp>
#include <vector>
void draw(GLuint buffer);

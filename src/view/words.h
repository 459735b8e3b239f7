// Numbers as people read them.
#pragma once

#include "crease/vec.h"

#include <cstdint>
#include <string>

namespace crease {

std::string grouped(std::uint64_t count);   // 1 234 567
std::string in_bytes(std::uint64_t bytes);  // 12.3 MB
std::string in_digits(double value);        // four significant ones
std::string in_digits(const Vec3d& v);      // three of those

}  // namespace crease

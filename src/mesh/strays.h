// What is small beside a model is so beside most of its vertices, wherever a stray one stands. See
// find_strays() of crease/mesh.h.
#pragma once

#include "crease/mesh.h"
#include "mesh/box_of.h"

#include <optional>

namespace crease {

// Around all others; nothing where there are no strays. Time O(vertices).
std::optional<PointBox> box_without_strays(const Mesh& mesh);

// That box's longest side, or the one of all vertices. Time O(vertices).
double longest_without_strays(const Mesh& mesh);

}  // namespace crease

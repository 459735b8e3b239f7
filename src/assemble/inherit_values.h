// Takes away values that an attribute has from its parent, where a move does not ask for them.
#pragma once

#include "crease/mesh_hierarchy.h"

namespace crease {

// Where v_s and the split above it keep all values, the attributes of v_s are looked up by nobody
// but who extracts or checks: corners have brought their values along. Such attributes lose their
// place in value_of_attribute, unless bytes are not fewer then. Time O(attributes).
void inherit_values(const VertexHierarchy& vertices, AttributeHierarchy& layer);

}  // namespace crease

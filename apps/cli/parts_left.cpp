#include "cli/parts_left.h"

#include "cli/text.h"

#include <algorithm>
#include <vector>

namespace crease::cli {

Json PartsLeft::json() const {
  return full > 0 ? Json{{"parts", left}, {"full_parts", full}} : Json::object();
}

std::string PartsLeft::words() const {
  return left < full ? ", " + grouped(left) + " of " + grouped(full) + " parts" : "";
}

PartsLeft parts_left(const Mesh& level) {
  if (level.part_of_triangle.empty()) return {};
  std::vector<bool> is_there(level.parts.size());
  for (const PartId part : level.part_of_triangle) is_there[index_of(part)] = true;
  return {static_cast<std::size_t>(std::ranges::count(is_there, true)), level.parts.size()};
}

}  // namespace crease::cli

// How many parts a level still shows.
#pragma once

#include "cli/command.h"
#include "crease/mesh.h"

#include <cstddef>
#include <string>

namespace crease::cli {

// Nothing, no field and no word, where the level knows of no parts.
struct PartsLeft {
  std::size_t left = 0, full = 0;  // those that have triangles; all

  Json json() const;          // parts, full_parts
  std::string words() const;  // ", 852 of 2 761 parts", where some are gone
};

PartsLeft parts_left(const Mesh& level);

}  // namespace crease::cli

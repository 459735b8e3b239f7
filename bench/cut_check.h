// Frames of a flight against brute force, by what the tests have for it.
//
//   Result<CutCheck> check = CutCheck::open("city.crease");    // decodes all of it once
//   const CutCheck::Found found = check->look(streamer.mesh());
//   if (!found.is_right()) ...
#pragma once

#include "crease/block_mesh.h"
#include "crease/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace crease::bench {

class CutCheck {
 public:
  struct Found {
    std::size_t triangles = 0;     // that were looked at
    std::size_t open_edges = 0;    // none in a closed model: no crack, no hole
    std::size_t wrong_blocks = 0;  // that are not those of the file
    // Of what is drawn and extracted, against the definition of a cut: every triangle of the
    // refined blocks with the active ancestors of its corners.
    std::size_t differences = 0;

    bool is_right() const { return open_edges + wrong_blocks + differences == 0; }
  };

  // The file that is flown through, as it is on this machine. Memory: that of all blocks, until it
  // returns.
  static Result<CutCheck> open(const std::filesystem::path& path);

  // Seconds and a kilobyte a triangle that is shown; the rest of the memory is given back.
  Found look(const BlockMesh& mesh) const;

 private:
  std::vector<std::uint64_t> checksums_;  // of every block as it is drawn
};

}  // namespace crease::bench

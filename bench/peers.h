// The peers as programs: each is run once per model and target, its result stays in a cache.
#pragma once

#include "peers/exchange.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crease::bench {

struct Peer {
  std::string name;
  std::vector<std::string> command;  // IN OUT TRIANGLES follow
};

// update, attributes (meshoptimizer), vtk, lt (CGAL), openmesh. `programs` is where the peers were
// built to; beside it is bench_cache/, where npm put meshoptimizer (setup.sh).
std::vector<Peer> all_peers(const std::filesystem::path& programs);

// Runs a command and gives the last line it printed, or nothing when it failed.
std::optional<std::string> run_command(const std::vector<std::string>& command);

struct PeerResult {
  exchange::Mesh mesh;
  double seconds = 0;
};
// From the cache folder of the model, where input.bin is; `seconds` as measured when it was made.
std::optional<PeerResult> run_peer(const Peer& peer, const std::filesystem::path& cache,
                                   std::size_t triangles);

}  // namespace crease::bench

#include "peers.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>

namespace crease::bench {

std::vector<Peer> all_peers(const std::filesystem::path& programs) {
  const std::string script = std::string(CREASE_BENCH_SOURCE) + "/peers/meshoptimizer.mjs";
  const std::filesystem::path modules = programs.parent_path() / "bench_cache";
  const auto node = [&](const char* mode) {
    return std::vector<std::string>{"node", script, modules.string(), mode};
  };
  return {{"update", node("update")},
          {"attributes", node("attributes")},
          {"vtk", {(programs / "peer_vtk").string()}},
          {"lt", {(programs / "peer_cgal").string()}},
          {"openmesh", {(programs / "peer_openmesh").string()}}};
}

std::optional<std::string> run_command(const std::vector<std::string>& command) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  const pid_t child = fork();
  if (child < 0) return std::nullopt;
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execvp(words[0], words.data());
    _exit(127);
  }
  close(ends[1]);
  std::string output;
  std::array<char, 4096> chunk;
  for (ssize_t got; (got = read(ends[0], chunk.data(), chunk.size())) > 0;) {
    output.append(chunk.data(), std::size_t(got));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  while (!output.empty() && output.back() == '\n') output.pop_back();
  const std::size_t last = output.rfind('\n');
  return last == std::string::npos ? output : output.substr(last + 1);
}

std::optional<PeerResult> run_peer(const Peer& peer, const std::filesystem::path& cache,
                                   std::size_t triangles) {
  const std::string stem = peer.name + "_" + std::to_string(triangles);
  const std::filesystem::path result = cache / (stem + ".bin"), time = cache / (stem + ".seconds");
  PeerResult found;
  if (!std::filesystem::exists(time)) {
    std::vector<std::string> command = peer.command;
    command.insert(command.end(),
                   {(cache / "input.bin").string(), result.string(), std::to_string(triangles)});
    const std::optional<std::string> seconds = run_command(command);
    if (!seconds) return std::nullopt;
    std::ofstream(time) << *seconds << '\n';
  }
  std::ifstream(time) >> found.seconds;
  if (!exchange::read_mesh(result.string(), found.mesh)) return std::nullopt;
  return found;
}

}  // namespace crease::bench

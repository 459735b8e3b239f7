// What an engine does: opens a file and switches its level of detail.
#include "crease/file.h"
#include "crease/progressive_mesh.h"

#include <cstdio>

int main(int argc, char** argv) {
  const char* path = argc > 1 ? argv[1] : "model.crease";
  crease::Result<crease::CreaseFile> file = crease::read_crease(path, {});
  if (!file.ok()) {
    std::fprintf(stderr, "%s\n", file.failure().message.c_str());
    return 1;
  }
  crease::ProgressiveMesh mesh(file->arrays);
  const std::size_t full = mesh.triangle_count();
  mesh.set_triangle_count(full / 10);
  std::printf("levels: %zu to %zu triangles\n", full, mesh.triangle_count());
  return mesh.triangle_count() < full ? 0 : 1;
}

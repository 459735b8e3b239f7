// What an engine does: opens a file and switches its level of detail.
#include "crease/build_progressive_arrays.h"
#include "crease/file.h"
#include "crease/progressive_mesh.h"

#include <cstdio>

int main(int argc, char** argv) {
  const char* path = argc > 1 ? argv[1] : "model.crease";
  crease::Result<crease::BlockFile> file = crease::open_crease(path);
  if (!file.ok()) {
    std::fprintf(stderr, "%s\n", file.failure().message.c_str());
    return 1;
  }
  crease::Result<crease::DecodedModel> model = crease::decode_model(*file);
  if (!model.ok()) {
    std::fprintf(stderr, "%s\n", model.failure().message.c_str());
    return 1;
  }
  crease::ProgressiveMesh mesh(crease::build_progressive_arrays(model->mesh, model->sequence));
  const std::size_t full = mesh.triangle_count();
  mesh.set_triangle_count(full / 10);
  std::printf("levels: %zu to %zu triangles\n", full, mesh.triangle_count());
  return mesh.triangle_count() < full ? 0 : 1;
}

// What a tool does: takes a mesh, builds its levels, and reads the bytes back.
#include "crease/build.h"
#include "crease/build_progressive_arrays.h"
#include "crease/generate.h"
#include "crease/progressive_mesh.h"

#include <cstdio>

int main() {
  crease::Result<crease::Built> built =
      crease::build_model(crease::generate_city({.triangles = 3000}), {});
  if (!built.ok()) return 1;
  crease::Result<crease::BlockFile> file =
      crease::BlockFile::open(crease::memory_source(built->file_bytes));
  if (!file.ok()) return 1;
  crease::Result<crease::DecodedModel> model = crease::decode_model(*file);
  if (!model.ok()) return 1;
  crease::ProgressiveMesh mesh(crease::build_progressive_arrays(model->mesh, model->sequence));
  const std::size_t full = mesh.triangle_count();
  mesh.set_triangle_count(full / 10);
  std::printf("levels: %zu to %zu triangles\n", full, mesh.triangle_count());
  return mesh.triangle_count() < full ? 0 : 1;
}

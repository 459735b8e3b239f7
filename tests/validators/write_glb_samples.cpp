// Writes GLBs of every kind into a folder, for the validator to read: the mesh zoo, everything that
// a mesh can carry, levels of detail, and the real models with normals and materials.
#include "crease/export.h"
#include "crease/import.h"
#include "io/gltf_sample.h"
#include "support/mesh_zoo.h"
#include "support/painted_sheet.h"
#include "support/shared_data.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace crease;

bool write_bytes(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return false;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  return std::fclose(file) == 0 && written;
}

bool report(const Failure& failure) {
  std::fprintf(stderr, "%s\n", failure.message.c_str());
  return false;
}

bool write(const Mesh& mesh, const std::filesystem::path& path) {
  const Result<ExportReport> done = export_mesh(mesh, path);
  return done.ok() || report(done.failure());
}

bool write_samples(const std::filesystem::path& folder) {
  for (const ZooMesh& z : mesh_zoo()) {
    if (!z.mesh.triangles.empty() && !write(z.mesh, folder / ("zoo_" + z.name + ".glb")))
      return false;
  }
  if (!write(everything_mesh(), folder / "everything.glb")) return false;
  // More than 65,535 vertices: wide indices.
  if (!write(faceted_sphere(120, 200), folder / "many_vertices.glb")) return false;
  Mesh painted = painted_sheet(3);
  painted.materials.push_back({"again", {1, 0, 0, 1}, "quarters.png"});
  painted.materials.push_back({"gone", {1, 1, 1, 1}, "gone.png"});
  painted.material_of_triangle[3] = MaterialId{1};
  painted.material_of_triangle[4] = MaterialId{2};
  if (!write(painted, folder / "painted.glb")) return false;
  Mesh bare = hard_box(1);
  bare.layers.clear();
  if (!write(bare, folder / "no_normals.glb")) return false;

  const std::vector<Mesh> levels = {smooth_sphere(40, 60), smooth_sphere(20, 30),
                                    everything_mesh()};
  const std::vector<double> coverage = {0.5, 0.25, 0.01};
  const auto lod = export_lod_glb(levels, coverage);
  if (!lod.ok()) return report(lod.failure());
  if (!write_bytes(folder / "levels.glb", *lod)) return false;

  for (const char* name : {"attributes/lantern.glb", "attributes/cow_viewpoint.obj.zst",
                           "attributes/cube_vertex_colours.glb", "attributes/materials_7.obj.zst",
                           "cad/hoppe_cessna.obj.zst", "cad/2cylinder_engine.glb.xz",
                           "city/berlin_52k.obj.zst", "nasty/everything_wrong_station.glb.xz",
                           "nasty/values_bad_normals.glb", "nasty/topology_moebius.obj"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty()) continue;
    const Result<Imported> in = import_mesh(path, {});
    if (!in.ok()) return report(in.failure());
    if (!write(in->mesh, folder / (path.filename().string() + ".glb"))) return false;
  }
  return true;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "write_glb_samples FOLDER\n");
    return 1;
  }
  return write_samples(arguments[1]) ? 0 : 1;
}

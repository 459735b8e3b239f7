// What an OBJ's material libraries say, and where they are found.
#include "crease/import.h"
#include "test_folder.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace crease {
namespace {

const std::string kQuadCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Imported import_obj(const Folder& folder, const std::string& obj) {
  folder.write("a.obj", obj);
  Result<Imported> in = import_mesh(folder.path / "a.obj", {});
  REQUIRE(in.ok());
  return *std::move(in);
}

TEST_CASE("d goes before Tr, in either order; Tr alone is 1 - d") {
  const Folder folder;
  const auto alpha_of = [&](const std::string& lines) {
    folder.write("a.mtl", "newmtl before\nd 0.75\nTr 0.75\nnewmtl red\n" + lines);
    return import_obj(folder, "mtllib a.mtl\n" + kQuadCorners + "usemtl red\nf 1 2 3\n")
        .mesh.materials[0]
        .base_color[3];
  };
  CHECK(alpha_of("d 1\nTr 1\n") == 1);
  CHECK(alpha_of("Tr 1\nd 1\n") == 1);
  CHECK(alpha_of("d 0.5\nKd 1 0 0\nTr 0.5\n") == 0.5f);
  CHECK(alpha_of("Tr 0.25\n") == 0.75f);
  CHECK(alpha_of("Kd 1 0 0\n") == 1);
}

TEST_CASE("materials that are fully transparent are told, if anything has them") {
  const Folder folder;
  folder.write("a.mtl", "newmtl red\nd 0\nnewmtl blue\nTr 1\nnewmtl green\n");
  const auto notes = [&](const char* first, const char* second) {
    const std::string faces = std::string("usemtl ") + first + "\nf 1 2 3\nusemtl " + second;
    return import_obj(folder, "mtllib a.mtl\n" + kQuadCorners + faces + "\nf 1 3 4\n").report.notes;
  };
  CHECK(notes("green", "green").empty());
  CHECK(notes("green", "blue") ==
        std::vector<std::string>{"1 material is fully transparent ('blue')"});
  CHECK(notes("blue", "red") ==
        std::vector<std::string>{"2 materials are fully transparent ('blue', ...)"});
}

}  // namespace
}  // namespace crease

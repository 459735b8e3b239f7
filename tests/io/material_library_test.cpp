// What an OBJ's material libraries say, and where they are found.
#include "crease/import.h"
#include "io/losses.h"
#include "io/read_mtl.h"
#include "test_folder.h"

#include <doctest/doctest.h>

#include <array>
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

TEST_CASE("a library that says Tr 1 of everything, and d of nothing, is opaque") {
  const Folder folder;
  const auto alpha_of = [&](const std::string& library) {
    folder.write("a.mtl", library);
    return import_obj(folder, "mtllib a.mtl\n" + kQuadCorners + "usemtl red\nf 1 2 3\n")
        .mesh.materials[0]
        .base_color[3];
  };
  const std::string red = "newmtl red\nKd 1 0 0\nTr 1.000000\n", other = "newmtl other\nTr ";
  CHECK(alpha_of(red) == 1);
  CHECK(alpha_of(red + other + "1\n") == 1);
  CHECK(alpha_of(red + other + "0\n") == 0);
  CHECK(alpha_of(red + "newmtl other\nd 1\n") == 0);
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

const std::string kRed = "newmtl red\nKd 1 0 0\n", kBlue = "newmtl blue\nKd 0 0 1\n";

// A model of a red and a blue triangle whose libraries are `named`: "red", "blue", "red blue" or ""
// as their colours arrived, and the notes.
struct Colors {
  std::string arrived;
  std::vector<std::string> notes;
};
Colors colors_of(const Folder& folder, const std::string& named) {
  const Imported in =
      import_obj(folder, named + kQuadCorners + "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n");
  Colors colors{"", in.report.notes};
  if (in.mesh.materials[0].base_color == std::array<float, 4>{1, 0, 0, 1}) colors.arrived += "red";
  if (in.mesh.materials[1].base_color == std::array<float, 4>{0, 0, 1, 1}) {
    colors.arrived += colors.arrived.empty() ? "blue" : " blue";
  }
  return colors;
}

TEST_CASE("a library may begin with a mark of UTF-8") {
  const Folder folder;
  folder.write("both.mtl", "\xEF\xBB\xBF" + kRed + kBlue);
  CHECK(colors_of(folder, "mtllib both.mtl\n").arrived == "red blue");
}

TEST_CASE("a library in a folder names textures as Windows does") {
  const Folder folder;
  folder.write("mats/one.mtl", "newmtl red\nmap_Kd ..\\tex\\a.png\n");
  const Imported in =
      import_obj(folder, "mtllib mats/one.mtl\n" + kQuadCorners + "usemtl red\nf 1 2 3\n");
  CHECK(in.mesh.materials[0].base_color_texture == "tex/a.png");
}

TEST_CASE("a library is found like an image: as written, in another case, by its last part") {
  const Folder folder;
  folder.write("both.mtl", kRed + kBlue);
  folder.write("lib/my both.mtl", kRed + kBlue);
  for (const char* name : {"both.mtl", "./both.mtl", ".\\both.mtl", "BOTH.MTL", "/home/me/both.mtl",
                           "../both.mtl", "C:\\models\\both.mtl", "C:\\my models\\both.mtl",
                           "/a/both.mtl # of CAD", "lib/my both.mtl", "LIB\\My Both.mtl"}) {
    CAPTURE(std::string(name));
    const Colors colors = colors_of(folder, std::string("mtllib ") + name + "\n");
    CHECK(colors.arrived == "red blue");
    CHECK(colors.notes.empty());
  }
}

TEST_CASE("several libraries in a line or in lines, wherever they are") {
  const Folder folder;
  folder.write("red.mtl", kRed);
  folder.write("lib/blue.mtl", kBlue);
  folder.write("blue.mtl", "newmtl blue\n");
  for (const char* lines :
       {"mtllib red.mtl lib/blue.mtl\n", "mtllib ./red.mtl ./lib/blue.mtl\n",
        "mtllib lib/red.mtl lib/blue.mtl\n", "mtllib red.mtl\nmtllib lib\\blue.mtl\n"}) {
    CAPTURE(std::string(lines));
    const Colors colors = colors_of(folder, lines);
    CHECK(colors.arrived == "red blue");
    CHECK(colors.notes.empty());
  }
}

TEST_CASE("several libraries in a line whose names have blanks in them") {
  const Folder folder;
  folder.write("my red.mtl", kRed);
  folder.write("my blue.MTL", kBlue);
  CHECK(colors_of(folder, "mtllib my red.mtl my blue.MTL\n").arrived == "red blue");
  const Colors colors = colors_of(folder, "mtllib my red.mtl gone.mtl\n");
  CHECK(colors.arrived == "red");
  CHECK(colors.notes[0] == "material library left out: no file 'gone.mtl'");
}

TEST_CASE("what materials lose of a library is told, of those that the model has") {
  const Folder folder;
  folder.write("a.mtl",
               "newmtl red\nKe 0 0 0\nmap_Ka red.png\nmap_d holes.png\nbump -bm 2 b.png\n"
               "map_Bump b.png\nnewmtl blue\nKe 0 0.5 0\nmap_d holes.png\n"
               "newmtl other\nmap_Ks s.png\n");
  CHECK(colors_of(folder, "mtllib a.mtl\n").notes ==
        std::vector<std::string>{"2 materials lose 'map_d'", "a material loses 'map_bump'",
                                 "a material loses emission"});
}

TEST_CASE("what is black but for emission has that as its colour") {
  std::vector<Material> materials(2);
  materials[0].name = "red";
  materials[1].name = "blue";
  std::vector<TexturePlacement> placements(2);
  std::vector<bool> is_known(2);
  Losses losses;
  read_mtl("newmtl red\nKe 1 0.5 0\nKd 0 0 0\nd 0.5\nnewmtl blue\nKd 0 0 0\n", "", materials,
           placements, is_known, losses);
  CHECK(materials[0].base_color == std::array<float, 4>{1, 0.5f, 0, 0.5f});
  CHECK(materials[1].base_color == std::array<float, 4>{0, 0, 0, 1});
  CHECK(losses.notes() ==
        std::vector<std::string>{
            "a material is black but for emission, which becomes the base colour"});
}

TEST_CASE("a library that is not there, or outside, is told once; so are materials without one") {
  const Folder folder;
  folder.write("red.mtl", kRed);
  folder.write("in/none.txt", "");
  const auto below = [&](const std::string& named) {
    folder.write("in/a.obj", named + kQuadCorners + "usemtl red\nf 1 2 3\n");
    const Result<Imported> in = import_mesh(folder.path / "in/a.obj", {});
    REQUIRE(in.ok());
    CHECK(in->mesh.materials[0].base_color == std::array<float, 4>{1, 1, 1, 1});
    return in->report.notes;
  };
  using Notes = std::vector<std::string>;
  CHECK(below("mtllib gone.mtl\nmtllib gone.mtl\n") ==
        Notes{"material library left out: no file 'gone.mtl'"});
  CHECK(
      below("mtllib ../red.mtl\n") ==
      Notes{"material library left out: '../red.mtl' is outside the model's folder, where nothing "
            "is read, and 'red.mtl' is not in it"});
  CHECK(below("") == Notes{"1 material is in no library: without a colour ('red')"});
  CHECK(colors_of(folder, "mtllib red.mtl gone.mtl\n").notes ==
        Notes{"material library left out: no file 'gone.mtl'",
              "1 material is in no library: without a colour ('blue')"});
}

TEST_CASE("a line of names without end is no long search") {
  const Folder folder;
  std::string names = "mtllib";
  for (int i = 0; i < 5000; ++i) names += " " + std::to_string(i) + ".mtl";
  const Colors colors = colors_of(folder, names + "\n");
  CHECK(colors.notes ==
        std::vector<std::string>{"material libraries left out: more than 4096 names"});
}

}  // namespace
}  // namespace crease

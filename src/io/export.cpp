#include "crease/export.h"

#include "base/output_file.h"
#include "crease/write_file.h"
#include "io/float_positions.h"
#include "io/formats.h"
#include "io/images.h"
#include "io/left_out.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace crease {

namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

Result<std::vector<std::byte>> bytes_of(const Mesh& mesh, std::string_view extension) {
  const std::string ending = lower_case(std::string(extension));
  if (ending == ".obj") return write_obj(mesh, {});
  if (ending == ".ply") return write_ply(mesh);
  if (ending == ".stl") return write_stl(mesh);
  if (ending == ".glb") return write_glb(mesh);
  return fail(Error::NotSupported, std::string("'").append(extension).append(
                                       "' is not a format written here (.obj .ply .stl .glb)"));
}

}  // namespace

Result<std::vector<std::byte>> export_bytes(const Mesh& mesh, std::string_view extension) {
  return bytes_of(mesh, extension);
}

namespace {

// "level_wood.png" for the image "textures/wood.png" of level.obj: a name of letters, digits and
// the like, which every reader of an MTL takes, and which no other model's file has.
std::vector<std::string> image_files(const Mesh& mesh, const std::string& stem) {
  std::vector<std::string> files;
  for (const ImageFile& image : mesh.images) {
    std::string name = image.name.substr(image.name.find_last_of("/\\") + 1);
    for (char& c : name) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-';
      if (!plain) c = '_';
    }
    const std::string ending = image_type(*image.bytes) == "image/jpeg" ? ".jpg" : ".png";
    const std::string lower = lower_case(name);
    if (lower.ends_with(ending)) name.resize(name.size() - ending.size());
    if (lower.ends_with(".jpeg") && ending == ".jpg") name.resize(name.size() - 5);
    std::string file = stem + "_" + name + ending;
    for (int i = 2; std::find(files.begin(), files.end(), file) != files.end(); ++i) {
      file = stem + "_" + name + "_" + std::to_string(i) + ending;
    }
    files.push_back(std::move(file));
  }
  return files;
}

// What of the mesh lies beside its file.
struct FilesBeside {
  bool is_obj = false;
  std::vector<std::string> images;  // their names
  std::filesystem::path library;    // empty: none
};

FilesBeside files_beside(const Mesh& mesh, const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  FilesBeside beside{ending == ".obj", {}, {}};
  const bool names_materials = beside.is_obj && !mesh.materials.empty();
  if (names_materials || ending == ".ply") beside.images = image_files(mesh, path.stem().string());
  if (names_materials) beside.library = std::filesystem::path(path).replace_extension(".mtl");
  return beside;
}

// The file itself last, so that whoever sees it finds the others.
Status export_with(const FilesBeside& beside, const Mesh& mesh, const std::filesystem::path& path) {
  const std::vector<std::string>& names = beside.images;
  std::vector<OutputFile> files;
  const auto write = [&](const std::filesystem::path& to,
                         std::span<const std::byte> bytes) -> Status {
    Result<OutputFile> file = OutputFile::create(to);
    if (!file.ok()) return file.failure();
    if (Status done = file->write(0, bytes); !done.ok()) return done;
    if (Status done = file->finish(); !done.ok()) return done;
    files.push_back(*std::move(file));
    return Done{};
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Status done = write(path.parent_path() / names[i], *mesh.images[i].bytes);
    if (!done.ok()) return done;
  }
  if (!beside.library.empty()) {
    const Status done = write(beside.library, write_mtl(mesh, names));
    if (!done.ok()) return done;
  }
  const Status done =
      write(path, beside.is_obj ? write_obj(mesh, beside.library.filename().string())
                                : write_ply(mesh, names));
  if (!done.ok()) return done;
  for (OutputFile& file : files) {
    if (const Status there = file.commit(); !there.ok()) return there;
  }
  return Done{};
}

}  // namespace

ExportReport export_report(const Mesh& mesh, std::string_view extension) {
  const std::string ending = lower_case(std::string(extension));
  ExportReport report;
  report.left_out = left_out(mesh, ending);
  if (ending == ".stl") {
    report.origin = round_origin(mesh);
    report.rounding = float_rounding(mesh, report.origin);
  }
  if (ending == ".glb") report.rounding = float_rounding(mesh, middle_origin(mesh));
  return report;
}

std::vector<std::filesystem::path> files_of_export(const Mesh& mesh,
                                                   const std::filesystem::path& path) {
  const FilesBeside beside = files_beside(mesh, path);
  std::vector<std::filesystem::path> files;
  for (const std::string& image : beside.images) files.push_back(path.parent_path() / image);
  if (!beside.library.empty()) files.push_back(beside.library);
  files.push_back(path);
  return files;
}

Result<ExportReport> export_mesh(const Mesh& mesh, const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  const FilesBeside beside = files_beside(mesh, path);
  if (!beside.library.empty() || !beside.images.empty()) {
    const Status written = export_with(beside, mesh, path);
    if (!written.ok()) return written.failure();
    return export_report(mesh, extension);
  }
  const Result<std::vector<std::byte>> bytes = bytes_of(mesh, extension);
  if (!bytes.ok()) {
    return fail(bytes.failure().error, path.string() + ": " + bytes.failure().message);
  }
  const Status written = write_file(path, *bytes);
  if (!written.ok()) return written.failure();
  return export_report(mesh, extension);
}

}  // namespace crease

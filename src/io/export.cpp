#include "crease/export.h"

#include "io/formats.h"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include <unistd.h>

namespace crease {

namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

Failure cannot_write(const std::filesystem::path& path, int reason) {
  return fail(Error::WriteFailed, path.string() + ": cannot be written: " + std::strerror(reason));
}

// Beside the target, so that the rename stays on one file system; gone again if anything fails.
Status write_whole(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::filesystem::path aside = path;
  aside += ".part-";
  aside += std::to_string(::getpid());
  std::FILE* file = std::fopen(aside.c_str(), "wb");
  if (!file) return cannot_write(path, errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  int reason = written ? 0 : errno;
  if (std::fclose(file) != 0 && reason == 0) reason = errno;
  if (reason == 0 && std::rename(aside.c_str(), path.c_str()) != 0) reason = errno;
  if (reason == 0) return Done{};
  std::remove(aside.c_str());
  return cannot_write(path, reason);
}

Result<std::vector<std::byte>> bytes_of(const Mesh& mesh, std::string_view extension,
                                        std::string_view mtl_name) {
  const std::string ending = lower_case(std::string(extension));
  if (ending == ".obj") return write_obj(mesh, mtl_name);
  if (ending == ".ply") return write_ply(mesh);
  if (ending == ".stl") return write_stl(mesh);
  if (ending == ".glb") return write_glb(mesh);
  return fail(Error::NotSupported,
              std::string("'").append(extension).append("' is not a format written here (.obj .ply .stl .glb)"));
}

}  // namespace

Result<std::vector<std::byte>> export_bytes(const Mesh& mesh, std::string_view extension) {
  return bytes_of(mesh, extension, {});
}

Status export_mesh(const Mesh& mesh, const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  const bool has_library = lower_case(extension) == ".obj" && !mesh.materials.empty();
  const std::filesystem::path library = std::filesystem::path(path).replace_extension(".mtl");
  const Result<std::vector<std::byte>> bytes =
      bytes_of(mesh, extension, has_library ? library.filename().string() : std::string());
  if (!bytes.ok()) {
    return fail(bytes.failure().error, path.string() + ": " + bytes.failure().message);
  }
  // The library first: whoever sees the OBJ finds it.
  if (has_library) {
    if (Status done = write_whole(library, write_mtl(mesh)); !done.ok()) return done;
  }
  return write_whole(path, *bytes);
}

}  // namespace crease

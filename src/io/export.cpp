#include "crease/export.h"

#include "io/formats.h"

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

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

// A file that is complete but not yet under its name: beside the target, so that the rename stays
// on one file system; gone again unless it is put in place.
class AsideFile {
 public:
  explicit AsideFile(std::filesystem::path path) : path_(std::move(path)), aside_(path_) {
    aside_ += ".part-";
    aside_ += std::to_string(::getpid());
  }
  ~AsideFile() {
    if (written_) std::remove(aside_.c_str());
  }
  AsideFile(const AsideFile&) = delete;
  AsideFile& operator=(const AsideFile&) = delete;

  Status write(std::span<const std::byte> bytes) {
    std::FILE* file = std::fopen(aside_.c_str(), "wb");
    if (!file) return cannot_write(path_, errno);
    written_ = true;
    const bool complete = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    int reason = complete ? 0 : errno;
    if (std::fclose(file) != 0 && reason == 0) reason = errno;
    if (reason != 0) return cannot_write(path_, reason);
    return Done{};
  }
  Status put_in_place() {
    if (std::rename(aside_.c_str(), path_.c_str()) != 0) return cannot_write(path_, errno);
    written_ = false;
    return Done{};
  }

 private:
  std::filesystem::path path_, aside_;
  bool written_ = false;
};

Result<std::vector<std::byte>> bytes_of(const Mesh& mesh, std::string_view extension,
                                        std::string_view mtl_name) {
  const std::string ending = lower_case(std::string(extension));
  if (ending == ".obj") return write_obj(mesh, mtl_name);
  if (ending == ".ply") return write_ply(mesh);
  if (ending == ".stl") return write_stl(mesh);
  if (ending == ".glb") return write_glb(mesh);
  return fail(Error::NotSupported, std::string("'").append(extension).append(
                                       "' is not a format written here (.obj .ply .stl .glb)"));
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
  AsideFile file(path), library_file(library);
  if (Status done = file.write(*bytes); !done.ok()) return done;
  // The library first: whoever sees the OBJ finds it.
  if (has_library) {
    if (Status done = library_file.write(write_mtl(mesh)); !done.ok()) return done;
    if (Status done = library_file.put_in_place(); !done.ok()) return done;
  }
  return file.put_in_place();
}

}  // namespace crease

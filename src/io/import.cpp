#include "crease/import.h"

#include "base/assert.h"
#include "io/formats.h"
#include "io/unpack.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>

namespace crease {

namespace {

using Reader = Result<RawMesh> (*)(const Source&);

struct Format {
  std::string_view ending;
  Reader read;
};

constexpr Format kFormats[] = {
    {".obj", read_obj},           {".ply", read_ply},       {".stl", read_stl},
    {".off", read_off},           {".gltf", read_gltf},     {".glb", read_gltf},
    {".b3dm", read_gltf},         {".json", read_cityjson}, {".jsonl", read_cityjson},
    {".cityjson", read_cityjson},
};

constexpr std::string_view kKnown = ".obj .ply .stl .off .gltf .glb .b3dm .json";

constexpr std::string_view kCreaseMagic =
    "\x89"
    "CREASE\n";  // docs/format.md

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

Reader reader_by_name(std::string_view name) {
  const std::string lower = lower_case(without_packing(lower_case(name)));
  for (const Format& format : kFormats) {
    if (lower.ends_with(format.ending)) return format.read;
  }
  return nullptr;
}

// For names that say nothing. OBJ has no mark of its own; a file that opens like one is taken as
// one.
Reader reader_by_first_bytes(std::string_view text) {
  const auto starts = [&](std::string_view with) { return text.starts_with(with); };
  if (starts("ply\n") || starts("ply\r")) return read_ply;
  if (starts("glTF") || starts("b3dm")) return read_gltf;
  if (starts("solid")) return read_stl;
  if (starts("OFF") || starts("COFF") || starts("NOFF") || starts("STOFF")) return read_off;
  const std::string_view head = text.substr(0, 4096);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first != head.npos && head[first] == '{') {
    return head.find("CityJSON") != head.npos ? read_cityjson : read_gltf;
  }
  for (std::string_view word : {"v ", "vn ", "mtllib ", "o ", "g "}) {
    if (starts(word) || head.find(std::string("\n").append(word)) != head.npos) return read_obj;
  }
  return nullptr;
}

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path) {
  const auto reason = [&](const char* what) {
    return path.string() + ": " + what + ": " + std::strerror(errno);
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return fail(Error::ReadFailed, path.string() + ": is a folder, not a file");
  }
  const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rb"),
                                                                &std::fclose);
  if (!file) {
    return fail(errno == ENOENT ? Error::NotFound : Error::ReadFailed, reason("cannot be opened"));
  }
  std::vector<std::byte> bytes;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  // One byte more than the file has, so that the end is seen without growing.
  std::size_t room = error ? std::size_t(1) << 20 : static_cast<std::size_t>(size) + 1;
  while (true) {
    const std::size_t before = bytes.size();
    bytes.resize(before + room);
    const std::size_t got = std::fread(bytes.data() + before, 1, room, file.get());
    bytes.resize(before + got);
    if (got < room) break;
    room = std::max(bytes.size() / 2, std::size_t(1) << 20);
  }
  if (std::ferror(file.get())) return fail(Error::ReadFailed, reason("cannot be read"));
  return bytes;
}

// What files are packed with that is not read here; empty: nothing.
std::string_view foreign_packing_of(std::string_view text) {
  if (text.starts_with("\x1f\x8b")) return "gzip";
  if (text.starts_with("PK\x03\x04")) return "zip";
  if (text.starts_with("BZh")) return "bzip2";
  return {};
}

Result<RawMesh> read_raw(std::span<const std::byte> bytes, const std::string& name,
                         const ImportOptions& options, const std::filesystem::path* folder) {
  if (bytes.empty()) return fail(Error::BadFormat, name + ": byte 0: empty file");
  std::vector<std::byte> unpacked;
  if (const Packing packing = packing_of(bytes); packing != Packing::None) {
    Result<std::vector<std::byte>> got = unpack(bytes, packing, name);
    if (!got.ok()) return got.failure();
    unpacked = std::move(*got);
    bytes = unpacked;
    if (bytes.empty()) return fail(Error::BadFormat, name + ": byte 0: empty file when unpacked");
  }
  const Source source{bytes, name, folder, &options.progress};
  if (const std::string_view packing = foreign_packing_of(source.text()); !packing.empty()) {
    return fail(Error::NotSupported, name + ": byte 0: packed with " + std::string(packing) +
                                         "; unpack it first (.zst and .xz need not be)");
  }
  Reader read = reader_by_name(name);
  if (!read) read = reader_by_first_bytes(source.text());
  if (!read && source.text().starts_with(kCreaseMagic)) {
    return fail(Error::NotSupported,
                name + ": is a .crease file, not a mesh; it cannot be read from a pipe");
  }
  if (!read && source.text().starts_with("ISO-10303-21")) {
    return fail(Error::NotSupported, name + ": byte 0: STEP has no triangles; export one of " +
                                         std::string(kKnown) + " from a CAD program");
  }
  if (!read) {
    return fail(Error::NotSupported,
                name + ": byte 0: not a format known here (" + std::string(kKnown) + ")");
  }
  Result<RawMesh> raw = read(source);
  if (!raw.ok() || folder == nullptr) return raw;
  std::vector<std::filesystem::path> folders{*folder};
  if (options.texture_folder) folders.push_back(*options.texture_folder);
  for (std::string& note : find_images(folders, raw->materials, raw->images)) {
    raw->report.notes.push_back(std::move(note));
  }
  return raw;
}

Result<Imported> finish(Result<RawMesh> raw, const std::string& name,
                        const ImportOptions& options) {
  if (!raw.ok()) return raw.failure();
  return finish_import(std::move(*raw), options, name);
}

}  // namespace

Result<NormalPolicy> parse_normal_policy(std::string_view text) {
  if (text == "keep") return NormalPolicy{NormalPolicy::Kind::Keep};
  if (text == "flat") return NormalPolicy{NormalPolicy::Kind::Flat};
  if (text == "smooth") return NormalPolicy{NormalPolicy::Kind::Smooth};
  constexpr std::string_view kCrease = "crease:";
  if (text.starts_with(kCrease)) {
    NormalPolicy policy{NormalPolicy::Kind::Crease};
    const char* end = text.data() + text.size();
    const auto got = std::from_chars(text.data() + kCrease.size(), end, policy.crease_angle_deg);
    const double angle = policy.crease_angle_deg;
    if (got.ec == std::errc() && got.ptr == end && angle >= 0 && angle <= 180) return policy;
  }
  return fail(Error::CommandLine,
              std::string("normals '")
                  .append(text)
                  .append("': not keep, flat, smooth or crease:ANGLE (0 to 180 degrees)"));
}

Result<Imported> import_bytes(std::span<const std::byte> bytes, std::string_view name,
                              const ImportOptions& options, const std::filesystem::path* folder) {
  const std::string own_name(name);
  return finish(read_raw(bytes, own_name, options, folder), own_name, options);
}

Result<Imported> import_mesh(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string name = path.string();
  if (options.progress && !options.progress("read", 0)) {
    return fail(Error::Interrupted, name + ": interrupted");
  }
  // The file's bytes are gone before the mesh is welded: that is where memory peaks.
  Result<RawMesh> raw = [&]() -> Result<RawMesh> {
    const Result<std::vector<std::byte>> bytes = read_file(path);
    if (!bytes.ok()) return bytes.failure();
    const std::filesystem::path folder = path.parent_path();
    return read_raw(*bytes, name, options, &folder);
  }();
  return finish(std::move(raw), name, options);
}

}  // namespace crease

#include "io/read_beside.h"

#include "io/text.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <system_error>
#include <utility>

namespace crease {

namespace {

bool is_same_but_for_case(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

// `relative` as folders have it, where none has it as written: the first by name of those that
// differ by case alone. Files of other systems say "Wood.JPG" of wood.jpg.
std::filesystem::path in_their_case(const std::filesystem::path& root,
                                    const std::filesystem::path& relative) {
  namespace fs = std::filesystem;
  fs::path path = root;
  for (const fs::path& part : relative) {
    std::error_code error;
    fs::path found = path / part;
    if (!fs::exists(found, error)) {
      std::string best;
      for (fs::directory_iterator entry(path, error), end; !error && entry != end;
           entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (is_same_but_for_case(name, part.string()) && (best.empty() || name < best)) best = name;
      }
      if (best.empty()) return root / relative;
      found = path / best;
    }
    path = found;
  }
  return path;
}

}  // namespace

Result<std::vector<std::byte>> read_in_folder(const std::filesystem::path& folder,
                                              const std::string& name, std::size_t max_bytes) {
  namespace fs = std::filesystem;
  const auto outside = [&] {
    return fail(Error::BadValue, in_quotes(name) + " is not a file beside it");
  };
  const auto missing = [&] { return fail(Error::NotFound, "no file " + in_quotes(name)); };
  if (name.empty() || name.find('\0') != name.npos || name.find("://") != name.npos ||
      name.find('\\') != name.npos) {
    return outside();
  }
  const fs::path relative(name);
  if (relative.is_absolute()) return outside();
  if (std::ranges::find(relative, fs::path("..")) != relative.end()) return outside();
  // A symbolic link could still lead out of the folder.
  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? "." : folder, error);
  if (error) return fail(Error::NotFound, "no folder to look in");
  const fs::path path = fs::canonical(in_their_case(root, relative), error);
  if (error) return missing();
  const auto [in_root, in_path] = std::ranges::mismatch(root, path);
  if (in_root != root.end()) return outside();
  if (!fs::is_regular_file(path, error)) return outside();

  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > max_bytes) {
    return fail(Error::OverLimit,
                in_quotes(name) + " has more than " + std::to_string(max_bytes) + " bytes");
  }
  std::ifstream file(path, std::ios::binary);
  if (error || !file) return fail(Error::ReadFailed, "cannot read " + in_quotes(name));
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

std::string with_slashes(std::string path) {
  std::ranges::replace(path, '\\', '/');
  return path;
}

Result<FileInFolder> find_in_folder(const std::filesystem::path& folder, const std::string& name,
                                    std::size_t max_bytes) {
  std::string path = with_slashes(name);
  Result<std::vector<std::byte>> bytes = read_in_folder(folder, path, max_bytes);
  const bool is_elsewhere = !bytes.ok() && (bytes.failure().error == Error::NotFound ||
                                            bytes.failure().error == Error::BadValue);
  const std::size_t slash = path.rfind('/');
  if (is_elsewhere && slash != path.npos && slash + 1 < path.size()) {
    const bool is_outside = bytes.failure().error == Error::BadValue;
    path.erase(0, slash + 1);
    bytes = read_in_folder(folder, path, max_bytes);
    if (is_outside && !bytes.ok() && bytes.failure().error == Error::NotFound) {
      return fail(Error::BadValue,
                  in_quotes(name) + " is outside the model's folder, where nothing is read, and " +
                      in_quotes(path) + " is not in it");
    }
  }
  if (!bytes.ok()) return bytes.failure();
  return FileInFolder{std::move(path), *std::move(bytes)};
}

}  // namespace crease

#include "io/material_libraries.h"

#include "io/raw_mesh.h"
#include "io/read_beside.h"
#include "io/text.h"

#include <cctype>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace crease {

namespace {

constexpr std::size_t kMaxLibraryBytes = std::size_t(256) << 20;
constexpr std::size_t kMaxNames = 4096;  // of libraries; they are looked for one by one

std::vector<std::string> words_of(std::string_view named) {
  std::vector<std::string> words;
  Line line{named.data(), named.data() + named.size(), 0};
  while (!line.done()) {
    const std::string_view word = line.word();
    if (word.starts_with('#')) break;
    words.emplace_back(word);
  }
  return words;
}

// Of a line of names with blanks in them: each goes up to its ending.
std::vector<std::string> names_of(const std::vector<std::string>& words) {
  const auto is_end = [](const std::string& word) {
    if (word.size() < 4) return false;
    std::string ending = word.substr(word.size() - 4);
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending == ".mtl";
  };
  std::vector<std::string> names;
  bool goes_on = false;
  for (const std::string& word : words) {
    if (goes_on) {
      names.back() += ' ' + word;
    } else {
      names.push_back(word);
    }
    goes_on = !is_end(word);
  }
  return names;
}

class LibraryReader {
 public:
  LibraryReader(const std::filesystem::path& folder, std::span<Material> materials)
      : folder_(folder), materials_(materials) {
    libraries_.placement_of_material.resize(materials.size());
    for (const Material& material : materials) {
      is_known_.push_back(material.name.empty());  // of faces that name none
    }
  }

  MaterialLibraries read(std::span<const std::string> named) {
    std::set<std::string_view> seen;
    for (const std::string& names : named) {
      if (!seen.insert(names).second) continue;  // some exporters repeat it for each object
      const std::vector<std::string> words = words_of(names);
      name_count_ += words.size() + 1;
      if (name_count_ > kMaxNames) {
        libraries_.notes.push_back("material libraries left out: more than " +
                                   std::to_string(kMaxNames) + " names");
        break;
      }
      read_line(names, words);
    }
    for (std::string& note : losses_.notes()) libraries_.notes.push_back(std::move(note));
    // Where libraries were named and none was read, all are, and each has a note of its own.
    if (any_ || named.empty()) {
      is_known_.flip();
      note_materials(materials_, is_known_, "in no library: without a colour", libraries_.notes);
    }
    return std::move(libraries_);
  }

 private:
  // A path as written is surer than its last part alone, and one name than several.
  void read_line(const std::string& whole, std::vector<std::string> words) {
    if (take_as_written(whole)) return;
    std::optional<Failure> no_whole;
    if (!is_any_there(words)) {
      no_whole = take(whole);
      if (!no_whole) return;
      if (std::vector<std::string> names = names_of(words); is_any_there(names)) {
        words = std::move(names);
      }
    }
    std::vector<Failure> missing;
    for (const std::string& word : words) {
      if (const std::optional<Failure> failure = take(word)) missing.push_back(*failure);
    }
    if (no_whole && missing.size() == words.size()) missing = {*no_whole};
    for (const Failure& failure : missing) {
      libraries_.notes.push_back("material library left out: " + failure.message);
    }
  }

  bool is_any_there(const std::vector<std::string>& words) const {
    for (const std::string& word : words) {
      if (read_in_folder(folder_, with_slashes(word), kMaxLibraryBytes).ok()) return true;
    }
    return false;
  }

  bool take_as_written(const std::string& name) {
    const std::string path = with_slashes(name);
    const Result<std::vector<std::byte>> bytes = read_in_folder(folder_, path, kMaxLibraryBytes);
    if (bytes.ok()) read_library({path, *bytes});
    return bytes.ok();
  }

  // Nothing if it was read.
  std::optional<Failure> take(const std::string& name) {
    const Result<FileInFolder> file = find_in_folder(folder_, name, kMaxLibraryBytes);
    if (!file.ok()) return file.failure();
    read_library(*file);
    return std::nullopt;
  }

  void read_library(const FileInFolder& file) {
    const std::string_view text(reinterpret_cast<const char*>(file.bytes.data()),
                                file.bytes.size());
    read_mtl(text, std::filesystem::path(file.path).parent_path().generic_string(), materials_,
             libraries_.placement_of_material, is_known_, losses_);
    libraries_.files.push_back(folder_ / file.path);
    any_ = true;
  }

  const std::filesystem::path& folder_;
  std::span<Material> materials_;
  MaterialLibraries libraries_;
  Losses losses_;
  std::vector<bool> is_known_;  // a library has it
  std::size_t name_count_ = 0;
  bool any_ = false;  // was read
};

}  // namespace

MaterialLibraries read_material_libraries(const std::filesystem::path& folder,
                                          std::span<const std::string> named,
                                          std::span<Material> materials) {
  return LibraryReader(folder, materials).read(named);
}

}  // namespace crease

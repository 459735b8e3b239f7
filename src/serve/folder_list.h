// What a folder has to show, as a page and as JSON: its folders and its .crease files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace crease::serve {

struct ListedFile {
  std::string name;
  bool is_folder = false;
  std::uint64_t bytes = 0;
  std::string last_modified;
};

// Folders first, then by name. Without what open_below() refuses.
std::vector<ListedFile> list_folder(int folder, bool follow_symlinks);

// `path`: of the URL, for the title.
std::string list_as_html(std::string_view path, const std::vector<ListedFile>& files);
// {"folder": "/", "folders": ["a"], "files": [{"name": "b.crease", "url": "b.crease", "bytes": 1,
// ...}]}
std::string list_as_json(std::string_view path, const std::vector<ListedFile>& files);

}  // namespace crease::serve

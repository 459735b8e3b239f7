// The path of a URL as a file below a folder, and never as anything else.
//
// A path is opened one name at a time, each relative to the folder before, so no name can lead out
// and nothing can be swapped in between. Names that begin with a dot are refused, "." and ".."
// among them; so are encoded slashes, and what is no file and no folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/stat.h>

namespace crease::serve {

// An open file, which it closes.
class OpenFile {
 public:
  explicit OpenFile(int descriptor = -1) : descriptor_(descriptor) {}
  OpenFile(OpenFile&& other) noexcept : descriptor_(other.release()) {}
  OpenFile& operator=(OpenFile&& other) noexcept;
  ~OpenFile();

  int get() const { return descriptor_; }
  int release();  // for whoever closes it now
  explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

struct UrlPath {
  std::vector<std::string> names;
  bool ends_with_slash = false;
};

// "/a%20b/c.crease" is "a b", "c.crease". Nothing where a name is refused.
std::optional<UrlPath> parse_url_path(std::string_view path);

struct Opened {
  OpenFile file;
  struct stat facts {};

  bool is_folder() const { return S_ISDIR(facts.st_mode); }
};

// Nothing where there is no such file or folder, or a symbolic link is on the way that must not be
// followed.
std::optional<Opened> open_below(int folder, const std::vector<std::string>& names,
                                 bool follow_symlinks);

}  // namespace crease::serve

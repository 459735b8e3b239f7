#include "view/remembered_views.h"

#include <doctest/doctest.h>

#include <unistd.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace crease {

namespace {

// A folder that $XDG_STATE_HOME names while this lives.
class StateFolder {
 public:
  StateFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("crease_state_" + std::to_string(getpid()))) {
    setenv("XDG_STATE_HOME", path_.c_str(), 1);
  }
  ~StateFolder() {
    unsetenv("XDG_STATE_HOME");
    std::filesystem::remove_all(path_);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

TEST_CASE("each file is seen again from where it was seen last") {
  const StateFolder folder;
  Camera a, b;
  a.position = {1, 2, 3};
  b.position = {-4, 5, 1e6};
  CHECK_FALSE(remembered_view("some/a.crease"));
  REQUIRE(remember_view("some/a.crease", a).ok());
  REQUIRE(remember_view("https://host/b.crease?x=1", b).ok());
  CHECK(remembered_view("some/a.crease") == a);
  CHECK(remembered_view("some/../some/./a.crease") == a);  // the same file
  CHECK(remembered_view(std::filesystem::absolute("some/a.crease").string()) == a);
  CHECK(remembered_view("https://host/b.crease?x=1") == b);
  CHECK_FALSE(remembered_view("https://host/b.crease"));
  REQUIRE(remember_view("some/a.crease", b).ok());
  CHECK(remembered_view("some/a.crease") == b);
}

TEST_CASE("what was written there by others is no view") {
  const StateFolder folder;
  REQUIRE(remember_view("a.crease", Camera{}).ok());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (!entry.is_regular_file()) continue;
    for (const char* text : {"", "[]", "{\"source\":3}", "{\"source\":\"a.crease\"}"}) {
      std::ofstream(entry.path()) << text;
      CHECK_FALSE(remembered_view("a.crease"));
    }
  }
}

}  // namespace crease

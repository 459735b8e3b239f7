// The viewer's loop, step by step, on a display.
#include "view/app.h"

#include "crease/export.h"
#include "crease/file.h"
#include "support/mesh_zoo.h"
#include "view/streamed_model.h"
#include "view/two_part_city.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

namespace crease {

namespace {

// A folder for a test's files, also for what the viewer remembers.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() / ("crease_app_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
    setenv("XDG_STATE_HOME", path_.c_str(), 1);
  }
  ~Folder() { std::filesystem::remove_all(path_); }

  std::string crease_file(const char* name, const Mesh& mesh) const {
    const std::string path = path_ / name;
    REQUIRE(write_crease(path, streamed_model(mesh, 400).bytes).ok());
    return path;
  }
  std::string mesh_file(const char* name, const Mesh& mesh) const {
    const std::string path = path_ / name;
    REQUIRE(export_mesh(mesh, path).ok());
    return path;
  }
  std::string text_file(const char* name, const char* text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

struct Running {
  std::unique_ptr<ViewerWindow> window;
  std::unique_ptr<App> app;

  explicit Running(const ViewerOptions& options) {
    Result<std::unique_ptr<ViewerWindow>> opened =
        ViewerWindow::open("test", options.width_px, options.height_px);
    if (!opened.ok()) FAIL(opened.failure().message);
    window = *std::move(opened);
    Result<GlCanvas> canvas = GlCanvas::make();
    REQUIRE(canvas.ok());
    app = std::make_unique<App>(options, *window, *std::move(canvas));
  }

  template <typename Holds>
  void until(Holds holds) {
    for (int i = 0; !holds(); ++i) {
      REQUIRE(i < 100'000);
      REQUIRE(app->step().ok());
    }
  }
  void until_complete() {
    until([&] { return app->frame().is_complete && !app->session().is_busy(); });
  }
  void drop(const std::string& path) {
    const char* paths[] = {path.c_str()};
    ViewerWindow::on_drop(window->handle(), 1, paths);
    REQUIRE(app->step().ok());
  }
};

ViewerOptions small_window(std::string source) {
  ViewerOptions options;
  options.source = std::move(source);
  options.width_px = 320;
  options.height_px = 240;
  return options;
}

}  // namespace

TEST_CASE("a file that is dropped replaces the model, one that is broken leaves it") {
  const Folder folder;
  Running viewer(small_window(folder.crease_file("sphere.crease", smooth_sphere(24, 48))));
  viewer.until_complete();
  const App& app = *viewer.app;
  CHECK(app.session().source().name == "sphere.crease");
  CHECK(app.frame().triangles > 100);
  CHECK_FALSE(app.session().message());

  viewer.drop(folder.text_file("broken.crease", "nothing of the kind"));
  viewer.until([&] { return app.session().failure().has_value(); });
  REQUIRE(app.session().message());
  CHECK(app.session().message()->is_failure);
  CHECK(app.session().message()->text.find("broken.crease") != std::string::npos);
  CHECK(app.session().source().name == "sphere.crease");
  REQUIRE(app.session().shown() != nullptr);
  for (int i = 0; i < 3; ++i) REQUIRE(viewer.app->step().ok());
  CHECK(app.frame().triangles > 100);
  viewer.app->act(Action::Leave);
  CHECK_FALSE(app.session().message());

  // A mesh file is built in the background, and says so meanwhile.
  viewer.drop(folder.mesh_file("box.ply", hard_box(8)));
  CHECK(app.session().is_busy());
  viewer.until([&] { return app.session().source().name == "box.ply"; });
  CHECK(app.session().source().built != nullptr);
  viewer.until_complete();
  CHECK(app.session().facts()->triangle_count == 768);
}

TEST_CASE("every mode shows the model, and comes back without loading it again") {
  const Folder folder;
  Running viewer(small_window(folder.crease_file("sphere.crease", smooth_sphere(24, 48))));
  viewer.until_complete();
  const App& app = *viewer.app;
  CHECK(app.settings().cut() == 0);
  for (const int cut : {1, 2, 3, 0}) {
    viewer.app->act(Action::NextMode);
    CHECK(app.settings().cut() == cut);
    REQUIRE(viewer.app->step().ok());
    CHECK(app.session().is_busy() == (app.settings().mode != ViewMode::Blocks));
    viewer.until_complete();
    CHECK(app.frame().triangles > 100);
    CHECK_FALSE(app.session().message());
  }
  const std::uint64_t bytes = app.session().bytes_read();
  viewer.app->act(Action::NextMode);
  REQUIRE(viewer.app->step().ok());
  CHECK_FALSE(app.session().is_busy());
  CHECK(app.session().bytes_read() == bytes);
}

TEST_CASE("what is frozen stays while the camera moves") {
  const Folder folder;
  ViewerOptions options = small_window(folder.crease_file("sphere.crease", smooth_sphere(48, 96)));
  options.pixels = 0.2;
  for (const ViewMode mode : {ViewMode::Blocks, ViewMode::Vertices, ViewMode::Linear}) {
    options.mode = mode;
    Running viewer(options);
    viewer.until_complete();
    viewer.until([&, i = 0]() mutable { return ++i > 5; });
    const std::size_t triangles = viewer.app->frame().triangles;
    const Camera camera = viewer.app->camera();
    viewer.app->act(Action::Outside);
    CHECK(viewer.app->is_frozen());
    CHECK_FALSE(viewer.app->camera() == camera);
    for (int i = 0; i < 5; ++i) REQUIRE(viewer.app->step().ok());
    CHECK(viewer.app->frame().triangles == triangles);
    viewer.app->act(Action::Freeze);
    CHECK_FALSE(viewer.app->is_frozen());
  }
}

TEST_CASE("the error asked for and the triangles allowed decide what is shown") {
  const Folder folder;
  ViewerOptions options = small_window(folder.crease_file("sphere.crease", smooth_sphere(48, 96)));
  {
    Running viewer(options);
    viewer.until_complete();
    const std::size_t at_one = viewer.app->frame().triangles;
    for (int i = 0; i < 4; ++i) viewer.app->act(Action::Coarser);
    CHECK(viewer.app->settings().pixels == 16);
    REQUIRE(viewer.app->step().ok());
    viewer.until_complete();
    CHECK(viewer.app->frame().triangles < at_one);
    for (int i = 0; i < 6; ++i) viewer.app->act(Action::Finer);
    REQUIRE(viewer.app->step().ok());
    viewer.until_complete();
    CHECK(viewer.app->frame().triangles > at_one);
  }

  options.max_triangles = 1500;
  options.pixels = 0.01;
  for (const ViewMode mode : {ViewMode::Blocks, ViewMode::Vertices, ViewMode::Linear}) {
    options.mode = mode;
    Running limited(options);
    limited.until_complete();
    CHECK(limited.app->frame().triangles <= 1500);
    CHECK(limited.app->frame().triangles > 100);
  }
}

TEST_CASE("what is clicked on is told with block, level, error, kind and part in every mode") {
  const Mesh mesh = two_part_city();
  const Folder folder;
  ViewerOptions options = small_window(folder.crease_file("city.crease", mesh));
  options.pixels = 0.01;
  Running viewer(options);
  App& app = *viewer.app;
  for (const ViewMode mode : {ViewMode::Blocks, ViewMode::Vertices, ViewMode::Linear}) {
    CAPTURE(int(mode));
    if (mode != ViewMode::Blocks) app.act(Action::NextMode);
    REQUIRE(app.step().ok());
    viewer.until_complete();
    for (int i = 0; i < 50; ++i) REQUIRE(app.step().ok());  // names of parts come last
    int hits = 0;
    for (double x = 10; x < 320; x += 15) {
      app.take_click({x, 120, false});
      if (app.picked().empty()) continue;
      ++hits;
      std::map<std::string, std::string> told(app.picked().begin(), app.picked().end());
      for (const char* name : {"block", "level", "error", "kind", "normal", "position"}) {
        CAPTURE(std::string(name));
        CHECK_FALSE(told[name].empty());
      }
      CHECK(told["kind"] == "FN: one normal");
      CHECK(told["part"] == (std::stod(told["position"]) < 1.5 ? "left" : "right"));
      CHECK(told["error"].find("pixels") != std::string::npos);
    }
    CHECK(hits > 4);
  }
}

TEST_CASE("beside the original the right half has all triangles, the left one what it is set to") {
  const Folder folder;
  ViewerOptions options = small_window(folder.crease_file("sphere.crease", smooth_sphere(48, 96)));
  options.pixels = 8;
  options.split = ViewSplit::Original;
  for (const ViewMode mode : {ViewMode::Blocks, ViewMode::Vertices, ViewMode::Linear}) {
    options.mode = mode;
    Running viewer(options);
    const App& app = *viewer.app;
    viewer.until([&] { return app.right_frame().is_complete; });
    viewer.until_complete();
    CAPTURE(int(mode));
    CHECK(app.right_frame().triangles == app.session().facts()->triangle_count);
    CHECK(app.frame().triangles < app.right_frame().triangles / 2);
    CHECK(app.frame().triangles > 10);
  }
}

TEST_CASE("two halves have settings of their own, and keys are for one of them") {
  const Folder folder;
  ViewerOptions options = small_window(folder.crease_file("sphere.crease", smooth_sphere(72, 144)));
  options.split = ViewSplit::Settings;
  options.right.pixels = 8;
  Running viewer(options);
  App& app = *viewer.app;
  viewer.until_complete();
  CHECK(app.right_frame().triangles < app.frame().triangles);

  app.act(Action::OtherHalf);
  for (int i = 0; i < 4; ++i) app.act(Action::Finer);
  CHECK(app.settings().pixels == 1);
  CHECK(app.split().right.pixels == 0.5);
  REQUIRE(app.step().ok());
  viewer.until_complete();
  CHECK(app.right_frame().triangles > app.frame().triangles);

  app.act(Action::NextMode);  // of the right half
  CHECK(app.split().right.vertices_in_blocks);
  app.act(Action::NextMode);  // it loads, the left one stays
  CHECK(app.split().right.mode == ViewMode::Vertices);
  REQUIRE(app.step().ok());
  viewer.until_complete();
  CHECK(app.settings().mode == ViewMode::Blocks);
  CHECK(app.frame().blocks > 0);
  CHECK(app.right_frame().blocks == 0);
  CHECK(app.right_frame().triangles > 100);
  const std::uint64_t bytes = app.session().bytes_read();
  app.act(Action::OtherHalf);
  for (int i = 0; i < 2; ++i)
    app.act(Action::NextMode);  // of the left half: out of the same arrays
  REQUIRE(app.step().ok());
  viewer.until_complete();
  CHECK(app.frame().blocks == 0);
  CHECK(app.frame().triangles > 100);
  CHECK(app.session().bytes_read() == bytes);

  app.act(Action::NextSplit);
  CHECK(app.split().kind == ViewSplit::Off);
  REQUIRE(app.step().ok());
  viewer.until_complete();
  CHECK(app.session().shown(1) == nullptr);
}

TEST_CASE("a window that is closed while a model is built ends the build") {
  const Folder folder;
  const std::string path = folder.mesh_file("sphere.ply", smooth_sphere(200, 400));
  Running viewer(small_window(path));
  for (int i = 0; i < 3; ++i) REQUIRE(viewer.app->step().ok());
  CHECK(viewer.app->session().is_busy());
  viewer.app.reset();  // returns
}

}  // namespace crease

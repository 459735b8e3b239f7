// The viewer's loop: what the user does, what has arrived, a picture, and again.
//
// A picture is drawn when something has changed; while blocks arrive, for a third of the time at
// most, so that a slow OpenGL does not slow down what it waits for. While nothing changes the loop
// waits for events; it looks ten times a second whether the background has done something, a
// hundred times while the view is not complete.
#pragma once

#include "crease/viewer.h"
#include "view/camera_input.h"
#include "view/flight.h"
#include "view/gui.h"
#include "view/histories.h"
#include "view/painter.h"
#include "view/panels.h"
#include "view/session.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crease {

inline constexpr int kSettlingFrames = 3;  // until panels look as they will

class App {
 public:
  // The window's OpenGL is current and stays so.
  App(const ViewerOptions& options, ViewerWindow& window, GlCanvas canvas);

  // Until the window is closed, or the picture that the options ask for is written.
  Result<ViewerReport> run();

  // The loop's body; for tests as well.
  Status step();
  void act(Action action);

  const ViewSettings& settings() const { return settings_; }
  const SplitSettings& split() const { return split_; }
  const StreamSettings& stream() const { return stream_; }
  const Camera& camera() const { return camera_; }
  const Session& session() const { return session_; }
  const FrameFacts& frame() const { return frame_; }
  const FrameFacts& right_frame() const { return right_frame_; }
  const Lines& picked() const { return picked_lines_; }  // what was said of it, last
  void take_click(const Click& click);
  bool is_frozen() const { return frozen_.has_value(); }

 private:
  double now() const;
  void take_events();
  void take_event(const WindowEvent& event);
  void open(const std::string& source);
  void welcome();      // a model that is there now
  void move_camera();  // by the flight, by keys, to fit
  void fit();
  bool fit_again();  // to what has arrived; false if the camera stays
  void freeze(bool on);
  void look_from_outside();
  void toggle_recording();
  void write_picture();
  void say(std::string notice);
  void remember();
  // Under a point of the window.
  std::optional<Hit> hit_at(double x, double y) const;
  Ray ray_at(double x, double y) const;
  std::size_t side_at(double x) const;
  std::string block_at(double x, double y) const;

  // One side, or two: from the left, of so many columns.
  struct Columns {
    int left = 0, width = 1;
  };
  std::size_t side_count() const { return split_.kind == ViewSplit::Off ? 1 : 2; }
  // Of the window's picture; while it is minimised, of what it was.
  std::pair<int, int> size_px() const;
  Columns columns_of(std::size_t side) const;
  Camera sized(Camera camera, std::size_t side = 0) const;  // to a side
  ViewSettings settings_of(std::size_t side) const;
  ViewSettings& edited();  // what keys and panels change
  bool take_divider(const WindowEvent& event);
  bool poll_session();  // true: another model is there
  void update_right();

  bool is_drawing_due();
  Status draw();
  Status draw_sides();
  std::vector<HalfLabel> half_labels() const;
  PanelContent panel_content() const;
  std::vector<Segment> lines() const;
  double wait_seconds() const;
  Status finish_screenshot();  // when all of it is there
  Result<Image> final_picture();
  bool is_all_there() const;
  std::optional<Failure> cannot_finish() const;

  const ViewerOptions options_;
  ViewerWindow& window_;
  mutable std::pair<int, int> last_size_px_{1, 1};
  GlCanvas canvas_;
  Gui gui_;
  Session session_;
  ViewSettings settings_;  // of the left side, or of all
  SplitSettings split_;
  StreamSettings stream_;
  CameraInput input_;
  Histories histories_;
  Pace pace_;  // of bytes that are read
  FlightRecorder recorder_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();

  Camera camera_;
  bool is_fitted_ = true;  // nobody has moved the camera: it follows what arrives
  int fits_left_ = 0;      // before it stays, if nothing arrives
  bool is_first_ = true;   // model
  std::optional<Camera> frozen_;
  std::vector<Segment> frustum_;
  std::optional<Hit> picked_;
  Lines picked_lines_;
  std::optional<double> flight_began_;  // when the flight did that is played

  FrameFacts frame_;  // of the left side; what is uploaded, asked for and complete of both
  const ShownMesh* last_shown_ = nullptr;
  FrameFacts right_frame_;  // of the right side
  bool drags_divider_ = false;
  Switches switches_;
  std::string notice_;
  double notice_until_ = 0, last_step_ = 0;
  bool has_arrived_ = false;   // something that is not drawn yet
  double stream_draw_at_ = 0;  // what arrives before then waits for it
  int draws_left_ = kSettlingFrames;
  bool is_outside_ = false;              // as the options ask
  std::optional<Image> window_picture_;  // taken with the next picture if there is one
  bool is_done_ = false;
};

}  // namespace crease

// Flights: cameras and when they are reached, recorded and played.
#pragma once

#include "crease/viewer.h"

namespace crease {

// Between the two cameras around that time; at the ends the first and the last one. Must not be
// empty.
Camera camera_of(const Flight& flight, double seconds);

class FlightRecorder {
 public:
  // `now`: any clock's seconds. Cameras that come sooner after the last than a twentieth second
  // are left out, and those that stay as they are become two.
  void add(const Camera& camera, double now);
  bool is_on() const { return is_on_; }
  void start();
  Flight stop();

 private:
  bool is_on_ = false;
  double begin_ = 0;
  Flight flight_;
};

}  // namespace crease

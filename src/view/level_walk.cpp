#include "view/level_walk.h"

#include <algorithm>
#include <chrono>

namespace crease {

bool LevelWalk::go(ProgressiveMesh& mesh, const LevelGoal& goal, double seconds,
                   const std::function<void()>& after_step) {
  if (!(goal == goal_)) {
    is_limited_ &= goal.max_triangles == goal_.max_triangles;
    goal_ = goal;
    is_there_ = false;
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  while (!is_there_) {
    is_there_ = step(mesh, goal, after_step);
    if (mesh.is_moving()) break;
    if (std::chrono::duration<double>(Clock::now() - begin).count() >= seconds) break;
  }
  return is_there_;
}

bool LevelWalk::step(ProgressiveMesh& mesh, const LevelGoal& goal,
                     const std::function<void()>& after_step) {
  const std::size_t wanted = mesh.applied_for_view(goal.error), now = mesh.applied();
  const auto limit = [&] {  // to the finest level that has few enough
    mesh.set_triangle_count(goal.max_triangles);
    after_step();
    is_limited_ = mesh.applied() >= wanted;
    return mesh.applied() == wanted || is_limited_;
  };
  if (mesh.triangle_count() > goal.max_triangles && now < mesh.contraction_count()) {
    mesh.set_applied(std::min(now + kStep, mesh.contraction_count()));
    after_step();
    if (mesh.triangle_count() > goal.max_triangles) return false;
    if (mesh.applied() <= wanted) return mesh.applied() == wanted;
    return limit();
  }
  if (now == wanted) return true;
  if (now < wanted) {
    is_limited_ = false;
    mesh.set_applied(std::min(now + kStep, wanted));
    after_step();
    return mesh.applied() == wanted;
  }
  if (is_limited_) return true;
  mesh.set_applied(std::max(now - std::min(now, kStep), wanted));
  after_step();
  if (mesh.triangle_count() > goal.max_triangles) return limit();
  return mesh.applied() == wanted;
}

}  // namespace crease

#include "view/whole_creases.h"

#include <chrono>

namespace crease {

namespace {

constexpr double kFindSeconds = 0.01;

}  // namespace

std::size_t WholeCreases::update(const DrawList& list, bool has_changed) {
  is_behind_ |= has_changed || !lines_;
  if (!is_behind_ || (lines_ && has_changed && seconds_ > kFindSeconds)) return 0;
  const auto begin = std::chrono::steady_clock::now();
  if (!lines_) lines_.emplace();
  const std::size_t uploaded = lines_->set(crease_lines(list), list.origin);
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  is_behind_ = false;
  return uploaded;
}

Status WholeCreases::draw(ProgramCache& programs, const DrawPass& pass,
                          const DrawStyle& style) const {
  return lines_ ? lines_->draw(programs, pass, style) : Status(Done{});
}

}  // namespace crease

// The crease lines of a mesh whose triangles are one list, kept up with it.
//
// Finding them takes a time that grows with the list, not with what changed: about 0.1 s for a
// million triangles. So while the mesh moves from frame to frame, and the last time took longer
// than kFindSeconds, the lines stay what they were; they follow when it rests.
#pragma once

#include "render/gl_creases.h"

#include <optional>

namespace crease {

class WholeCreases {
 public:
  // `has_changed`: since the last call. Returns the bytes uploaded.
  std::size_t update(const DrawList& list, bool has_changed);
  // Lines that nobody looks at are not kept up.
  void forget() { lines_.reset(); }
  Status draw(ProgramCache& programs, const DrawPass& pass, const DrawStyle& style) const;
  // Those of another moment.
  bool is_behind() const { return is_behind_; }
  std::size_t bytes() const { return lines_ ? lines_->bytes() : 0; }

 private:
  std::optional<GlCreases> lines_;
  double seconds_ = 0;  // that it took last time
  bool is_behind_ = true;
};

}  // namespace crease

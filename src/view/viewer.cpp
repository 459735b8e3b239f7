#include "crease/viewer.h"

#include "crease/http_source.h"
#include "view/app.h"

#include <system_error>

namespace crease {

Result<ViewerReport> run_viewer(const ViewerOptions& options) {
  std::error_code error;
  if (!options.source.empty() && !is_http_url(options.source) &&
      !std::filesystem::exists(options.source, error)) {
    return fail(Error::NotFound, options.source + ": no such file");
  }
  Result<std::unique_ptr<ViewerWindow>> window =
      ViewerWindow::open("crease", options.width_px, options.height_px);
  if (!window.ok()) return window.failure();
  Result<GlCanvas> canvas = GlCanvas::make();
  if (!canvas.ok()) {
    return fail(canvas.failure().error,
                "the window's OpenGL cannot draw: " + canvas.failure().message);
  }
  App app(options, **window, *std::move(canvas));
  return app.run();
}

}  // namespace crease

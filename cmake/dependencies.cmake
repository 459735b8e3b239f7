# The libraries that the build side needs; crease_runtime needs none of them. The installed package
# includes this file too, so that crease::crease finds the same targets.
#
#   target                  used by
#   TBB::tbb                parallel: threads
#   embree                  measure: closest points
#   zstd, lzma              io: compressed inputs (plain -l names)
#   draco, meshoptimizer    io: compressed glTF (plain -l names)
#   PNG::PNG                render: pictures
#   PkgConfig::CREASE_JPEG  render: textures
#   PkgConfig::CREASE_GL    render: epoxy and EGL
#   CURL::libcurl           http: the client's side
#   PkgConfig::CREASE_MHD   serve: libmicrohttpd, the host's side
# Header-only ones (nlohmann-json, fast_float, stb, CLI11) are found by the compiler.
macro(crease_find_dependencies)
  find_package(PkgConfig REQUIRED)
  find_package(Threads REQUIRED)
  find_package(TBB CONFIG REQUIRED)
  find_package(embree 3 CONFIG REQUIRED)
  find_package(PNG REQUIRED)
  find_package(CURL 7.85 REQUIRED)
  pkg_check_modules(CREASE_JPEG REQUIRED IMPORTED_TARGET GLOBAL libturbojpeg)
  pkg_check_modules(CREASE_GL REQUIRED IMPORTED_TARGET GLOBAL epoxy egl)
  pkg_check_modules(CREASE_MHD REQUIRED IMPORTED_TARGET GLOBAL libmicrohttpd>=0.9.73)
endmacro()

# What the viewer needs besides, which is part of the tool and not of the package.
#
#   PkgConfig::CREASE_GLFW, PkgConfig::CREASE_IMGUI   view: windows and panels
macro(crease_find_viewer_dependencies)
  pkg_check_modules(CREASE_GLFW REQUIRED IMPORTED_TARGET GLOBAL glfw3>=3.3)
  pkg_check_modules(CREASE_IMGUI REQUIRED IMPORTED_TARGET GLOBAL imgui)
endmacro()

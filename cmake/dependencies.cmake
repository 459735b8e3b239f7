# The libraries that the build side needs; crease_runtime needs none of them. The installed package
# includes this file too, so that crease::crease finds the same targets.
#
#   target                  used by
#   TBB::tbb                simplify, pipeline: threads
#   embree                  measure: closest points
#   PkgConfig::crease_zstd  io, codec: compressed inputs
#   LibLZMA::LibLZMA        io: .xz inputs
#   PNG::PNG                render: pictures
#   PkgConfig::crease_gl    render: epoxy (OpenGL and EGL entry points)
# Header-only ones (nlohmann-json, fast_float, xxhash, stb, CLI11) are found by the compiler.
macro(crease_find_dependencies)
  find_package(PkgConfig REQUIRED)
  find_package(Threads REQUIRED)
  find_package(TBB CONFIG REQUIRED)
  find_package(embree 3 CONFIG REQUIRED)
  find_package(LibLZMA REQUIRED)
  find_package(PNG REQUIRED)
  pkg_check_modules(crease_zstd REQUIRED IMPORTED_TARGET GLOBAL libzstd)
  pkg_check_modules(crease_gl REQUIRED IMPORTED_TARGET GLOBAL epoxy egl)
endmacro()

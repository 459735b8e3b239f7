# The libraries that the build side needs; crease_runtime needs none of them. The installed package
# includes this file too, so that crease::crease finds the same targets.
#
#   target                  used by
#   TBB::tbb                parallel: threads
#   embree                  measure: closest points
#   zstd, lzma              io: compressed inputs (plain -l names)
#   PNG::PNG                render: pictures
#   PkgConfig::CREASE_GL    render: epoxy and EGL
# Header-only ones (nlohmann-json, fast_float, stb, CLI11) are found by the compiler.
macro(crease_find_dependencies)
  find_package(PkgConfig REQUIRED)
  find_package(Threads REQUIRED)
  find_package(TBB CONFIG REQUIRED)
  find_package(embree 3 CONFIG REQUIRED)
  find_package(PNG REQUIRED)
  pkg_check_modules(CREASE_GL REQUIRED IMPORTED_TARGET GLOBAL epoxy egl)
endmacro()

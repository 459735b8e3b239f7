# What others link. crease_runtime: what an engine or a browser needs, without a line of the build
# side. crease: all of it but two things; it brings crease_runtime along. crease_view, the viewer, and
# crease_spill, memory in a file, are for the tool alone: nobody else is to need a window, or to have
# a say in where a program's memory is.
crease_library(crease_runtime NAME runtime FOLDERS ${CREASE_RUNTIME_FOLDERS})
if(NOT CREASE_RUNTIME_ONLY)
  set(build_side ${CREASE_FOLDERS})
  list(REMOVE_ITEM build_side ${CREASE_RUNTIME_FOLDERS} view spill)
  list(APPEND build_side codec_encode)
  crease_library(crease NAME crease FOLDERS ${build_side} LINKS crease_runtime)
  if(CREASE_CLI)
    crease_library(crease_view NAME view FOLDERS view LINKS crease)
    crease_library(crease_spill NAME spill FOLDERS spill LINKS crease_runtime)
  endif()
endif()

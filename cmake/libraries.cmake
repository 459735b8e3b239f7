# What others link. crease_runtime: what an engine or a browser needs, without a line of the build.
# crease: all of it.
crease_library(crease_runtime base mesh hierarchy codec runtime)
crease_library(crease ${CREASE_FOLDERS})
add_library(crease::runtime ALIAS crease_runtime)
add_library(crease::crease ALIAS crease)

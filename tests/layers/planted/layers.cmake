# A small tree in which every rule of check_layers.cmake is broken once.
set(CREASE_FOLDERS base codec measure)
set(CREASE_LAYER_codec   base)
set(CREASE_LAYER_measure base)
set(CREASE_HEADERS_base    words.h)
set(CREASE_HEADERS_measure compare.h)
set(CREASE_THIRD_PARTY embree3)
set(CREASE_THIRD_PARTY_embree3 measure)

# The check must find what is planted, line for line, and nothing else.
cmake_minimum_required(VERSION 3.25)
execute_process(
  COMMAND ${CMAKE_COMMAND} -DROOT=${CMAKE_CURRENT_LIST_DIR}/planted
    -DTABLES=${CMAKE_CURRENT_LIST_DIR}/planted/layers.cmake
    -P ${CMAKE_CURRENT_LIST_DIR}/check_layers.cmake
  RESULT_VARIABLE code ERROR_VARIABLE output)
if(code EQUAL 0)
  message(FATAL_ERROR "a tree that breaks every rule passed")
endif()
string(REGEX MATCHALL "(src|include|apps|tests)/[^\n]*: [^\n]*|src/extra: [^\n]*" found "${output}")
set(expected
  "src/base/upwards.cpp: base may not include measure/tree.h"
  "include/crease/words.h: a public header includes base/private.h"
  "include/crease/words.h: a public header includes <nlohmann/json.hpp>"
  "include/crease/words.h: names a type of another library: void draw(GLuint buffer)"
  "src/codec/decode_block.cpp: decoding includes codec/encode_block.h"
  "src/codec/elsewhere.cpp: <embree3/rtcore.h> may be included by measure only"
  "src/codec/elsewhere.cpp: crease/compare.h is a header of measure, which codec may not include"
  "src/codec/elsewhere.cpp: encode_block.h should be written folder/file.h"
  "include/crease/compare.h: <crease/words.h> should be \"crease/words.h\""
  "include/crease/unlisted.h: belongs to no folder in the table"
  "src/extra: is no folder in the table"
  "tests/plain_decoder/peeks.cpp: the plain decoder stands alone: #include \"codec/ring.h\""
  "tests/plain_decoder/peeks.cpp: the plain decoder stands alone: #include \"plain_decoder/difference_test.h\""
  "tests/plain_decoder/peeks.cpp: the plain decoder stands alone: #include <xxhash.h>"
  "apps/cli/main.cpp: an app includes codec/decode_block.h, which is not public")
foreach(line IN LISTS expected)
  if(NOT line IN_LIST found)
    message(SEND_ERROR "not found: ${line}")
  endif()
endforeach()
foreach(line IN LISTS found)
  if(NOT line IN_LIST expected)
    message(SEND_ERROR "not planted: ${line}")
  endif()
endforeach()

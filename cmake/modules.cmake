# GCC 12 warns falsely of overlap in "text" + std::string (GCC bug 105651).
set(CREASE_FALSE_WARNINGS
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)

# One object library per folder of src/, so that a test can link the folders it needs and the two
# installed libraries are put together from them (cmake/libraries.cmake).
#
#   crease_module(mesh SOURCES check_mesh.cpp snap.cpp DEPENDS base)
#   crease_module(measure SOURCES compare.cpp DEPENDS base mesh LIBRARIES embree)
#
# The presets compile each folder's files together (CMAKE_UNITY_BUILD), which takes half the time;
# so names in anonymous namespaces differ within a folder.
#
# Floating point follows the source to the letter everywhere (no contraction into FMA), so that the
# same input gives the same bytes with every compiler. Nobody asks errno what a root came to.
function(crease_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
  foreach(dependency IN LISTS ARG_DEPENDS)
    if(NOT dependency IN_LIST CREASE_LAYER_${name})
      message(FATAL_ERROR "${name} depends on ${dependency}, which cmake/layers.cmake forbids")
    endif()
  endforeach()
  add_library(crease_${name}_objects OBJECT ${ARG_SOURCES})
  target_compile_features(crease_${name}_objects PUBLIC cxx_std_20)
  target_include_directories(crease_${name}_objects
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  # Assertions name a file of the tree, wherever that was.
  target_compile_options(crease_${name}_objects PRIVATE -ffp-contract=off -fno-math-errno
    -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/= ${CREASE_FALSE_WARNINGS})
  if(name MATCHES "^(hierarchy|runtime)$" AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Else GCC inlines no function that another library might replace, not even within a file.
    target_compile_options(crease_${name}_objects PRIVATE -fno-semantic-interposition)
  endif()
  if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC takes what several files are put together in for a header.
    target_compile_options(crease_${name}_objects PRIVATE -Wno-subobject-linkage)
  endif()
  if(name MATCHES "^(render|view|http|serve)$")
    # They wait for a display or a line, and their code takes clang longest under sanitizers.
    target_compile_options(crease_${name}_objects PRIVATE
      $<$<CONFIG:Sanitize>:-O0 -fno-sanitize=undefined>)
  endif()
  if(CREASE_FUZZERS AND name IN_LIST CREASE_FUZZED_FOLDERS)
    target_compile_options(crease_${name}_objects PRIVATE -fsanitize=fuzzer-no-link)
  endif()
  if(name IN_LIST CREASE_RUNTIME_FOLDERS AND CREASE_RUNTIME_ONLY)
    target_compile_options(crease_${name}_objects PRIVATE -fno-exceptions -fno-rtti)
  endif()
  target_link_libraries(crease_${name}_objects PUBLIC ${ARG_LIBRARIES})
  foreach(dependency IN LISTS ARG_DEPENDS)
    target_link_libraries(crease_${name}_objects PUBLIC crease_${dependency}_objects)
  endforeach()
  set_property(GLOBAL PROPERTY crease_${name}_depends "${ARG_DEPENDS}")
  set_property(GLOBAL PROPERTY crease_${name}_libraries "${ARG_LIBRARIES}")
endfunction()

# A static library out of several folders, exported as crease::NAME. The libraries that the folders
# need come along.
#
#   crease_library(crease NAME crease FOLDERS io measure LINKS crease_runtime)
function(crease_library target)
  cmake_parse_arguments(ARG "" "NAME" "FOLDERS;LINKS" ${ARGN})
  add_library(${target} STATIC)
  add_library(crease::${ARG_NAME} ALIAS ${target})
  foreach(folder IN LISTS ARG_FOLDERS)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:crease_${folder}_objects>)
    get_property(libraries GLOBAL PROPERTY crease_${folder}_libraries)
    target_link_libraries(${target} PUBLIC ${libraries})
  endforeach()
  target_link_libraries(${target} PUBLIC ${ARG_LINKS})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:include>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES
    LINKER_LANGUAGE CXX EXPORT_NAME ${ARG_NAME})
endfunction()

# The folders that `folder` needs, itself included.
function(crease_closure folder result)
  set(all ${folder})
  get_property(direct GLOBAL PROPERTY crease_${folder}_depends)
  foreach(dependency IN LISTS direct)
    crease_closure(${dependency} more)
    list(APPEND all ${more})
  endforeach()
  list(REMOVE_DUPLICATES all)
  set(${result} ${all} PARENT_SCOPE)
endfunction()

# A program for development (test, fuzzer, benchmark) that links folders of src/ and may include
# their private headers.
#
#   crease_program(test_io SOURCES obj_test.cpp FOLDERS io)
function(crease_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;FOLDERS;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_compile_options(${name} PRIVATE -ffp-contract=off -fno-math-errno ${CREASE_FALSE_WARNINGS})
  set(folders)
  foreach(folder IN LISTS ARG_FOLDERS)
    crease_closure(${folder} closure)
    list(APPEND folders ${closure})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder IN LISTS folders)
    target_link_libraries(${name} PRIVATE crease_${folder}_objects)
  endforeach()
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES})
endfunction()

# A test program of doctest cases; tests/support has its main, the mesh zoo and the real models.
# THREADED ones also run under the thread sanitizer (scripts/test.sh tsan), those with THREADED_CASES
# only as far as they are in doctest's suite "threads". Those that draw with OpenGL say so (DRAWS).
#
#   crease_test(io SOURCES obj_test.cpp ply_test.cpp FOLDERS io)
#   crease_test(parallel SOURCES parallel_test.cpp FOLDERS parallel THREADED)
function(crease_test name)
  cmake_parse_arguments(ARG "THREADED;THREADED_CASES;DRAWS" "" "SOURCES;FOLDERS;LIBRARIES" ${ARGN})
  crease_program(test_${name} SOURCES ${ARG_SOURCES} FOLDERS ${ARG_FOLDERS} mesh
                 LIBRARIES crease_test_support ${ARG_LIBRARIES})
  # To compile doctest, RapidCheck and nlohmann-json takes longer than to run the tests; what they
  # test is as optimized and as watched as ever, but for functions of headers.
  set_target_properties(test_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  target_compile_definitions(test_${name} PRIVATE DOCTEST_CONFIG_SUPER_FAST_ASSERTS)
  target_compile_options(test_${name} PRIVATE
    $<$<CONFIG:Release>:-O1> $<$<CONFIG:Sanitize>:-O0 -fno-sanitize=undefined>)
  set(cases)
  if(ARG_THREADED_CASES AND NOT thread_sanitizer EQUAL -1)
    set(cases --test-suite=threads)
  endif()
  set(launcher)
  if(ARG_DRAWS AND CREASE_SANITIZED)
    set(launcher ${CREASE_PYTHON} -B ${PROJECT_SOURCE_DIR}/tests/support/leaks.py)
  endif()
  add_test(NAME ${name} COMMAND ${launcher} $<TARGET_FILE:test_${name}> ${cases})
  if(ARG_THREADED OR ARG_THREADED_CASES)
    set_tests_properties(${name} PROPERTIES LABELS threads)
    add_dependencies(threaded_tests test_${name})
  endif()
endfunction()

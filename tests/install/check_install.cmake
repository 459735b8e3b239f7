# Installs BUILD below WORK, moves the result, and builds and runs consumer/ against it; then builds
# it with crease as a subdirectory, where crease must add no flags, tests or tools of its own.
cmake_minimum_required(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${what} failed:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(here ${CMAKE_CURRENT_LIST_DIR})
file(REMOVE_RECURSE ${WORK})
run("install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first)
file(RENAME ${WORK}/first ${WORK}/moved)
set(model ${WORK}/model.crease)
run("generate" ${WORK}/moved/bin/crease generate city --triangles 3000 -o ${WORK}/city.ply)
run("build" ${WORK}/moved/bin/crease build ${WORK}/city.ply -o ${model})

function(consume name)
  set(common ${CMAKE_COMMAND} -G ${GENERATOR} -S ${here}/consumer -B ${WORK}/${name}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${CONFIG} "-DCMAKE_CXX_FLAGS=${FLAGS}")
  find_program(ccache ccache)
  if(ccache)
    list(APPEND common -DCMAKE_CXX_COMPILER_LAUNCHER=${ccache})
  endif()
  run("${name}: configure" ${common} ${ARGN})
  run("${name}: build" ${CMAKE_COMMAND} --build ${WORK}/${name})
  foreach(program IN ITEMS consumer_runtime consumer_build)
    if(EXISTS ${WORK}/${name}/${program})
      run("${name}: ${program}" ${WORK}/${name}/${program} ${model})
      if(NOT output MATCHES "levels: [0-9]+ to [0-9]+ triangles")
        message(FATAL_ERROR "${name}: ${program} said ${output}")
      endif()
    endif()
  endforeach()
endfunction()

consume(found -DCMAKE_PREFIX_PATH=${WORK}/moved)
consume(found_runtime -DCMAKE_PREFIX_PATH=${WORK}/moved -DRUNTIME_ONLY=ON)
# All of crease_runtime again: its folders put together and nothing optimized, to take a quarter of
# the time.
consume(subdirectory -DCREASE_SOURCE=${SOURCE} -DRUNTIME_ONLY=ON -DCMAKE_UNITY_BUILD=ON
  -DCMAKE_BUILD_TYPE=Debug)
if(NOT EXISTS ${WORK}/found/consumer_build OR NOT EXISTS ${WORK}/found_runtime/consumer_runtime OR
   NOT EXISTS ${WORK}/subdirectory/consumer_runtime)
  message(FATAL_ERROR "a consumer was not built")
endif()

find_program(pkg_config pkg-config)
file(GLOB_RECURSE pc ${WORK}/moved/*.pc)
get_filename_component(pc_dir ${pc} DIRECTORY)
run("pkg-config" ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc_dir}
  ${pkg_config} --cflags --libs crease_runtime)
separate_arguments(pkg_flags UNIX_COMMAND "${output} ${FLAGS}")
run("pkg-config: build" ${COMPILER} ${here}/consumer/runtime.cpp ${pkg_flags}
  -o ${WORK}/with_pkg_config)
run("pkg-config: run" ${WORK}/with_pkg_config ${model})

# Installs the simulator's part into a folder of its own, then configures, builds and runs a program against that.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(prefix "${WORK}/prefix")
file(REMOVE_RECURSE "${WORK}")
foreach(component IN ITEMS simulation data)
  run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}" --component ${component})
endforeach()

file(GLOB folders RELATIVE "${prefix}/include" "${prefix}/include/*")
if(NOT folders STREQUAL "sono")
  message(FATAL_ERROR "include/sono alone was expected to be installed: ${folders}")
endif()
file(GLOB_RECURSE texts "${prefix}/*.h" "${prefix}/*.cmake")
foreach(text IN LISTS texts)
  file(READ "${text}" content)
  string(FIND "${content}" "${ROOT}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${text} names a path of the source or build tree.")
  endif()
endforeach()

run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/Consumer" -B "${WORK}/build" -G "${GENERATOR}"
  "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE=Release)
run("${CMAKE_COMMAND}" --build "${WORK}/build")
run("${WORK}/build/consumer" "${VERSION}")

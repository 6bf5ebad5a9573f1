# Checks that a floor of the house knows only the floor beneath it, by its #include lines.
#   cmake -DROOT=<source tree> -P CheckLayers.cmake
cmake_minimum_required(VERSION 3.25)

set(volume_libraries "(openvdb|nanovdb|embree[0-9]*|tbb|oneapi|cuda[a-zA-Z_]*|nvrtc[a-zA-Z_]*|thrust|cub)(/|\\.)")
set(qt "(Q[A-Z]|Qt|pq[A-Z])")
set(violations)

function(list_files folder result)
  file(GLOB_RECURSE files
    "${ROOT}/${folder}/*.h" "${ROOT}/${folder}/*.hpp" "${ROOT}/${folder}/*.cpp" "${ROOT}/${folder}/*.cxx"
    "${ROOT}/${folder}/*.cu" "${ROOT}/${folder}/*.cuh")
  set(${result} "${files}" PARENT_SCOPE)
endfunction()

# No file of `folder` may include a name that begins with `pattern`, nor a header that lives in one of the folders
# given after it.
function(check folder pattern)
  list_files(${folder} files)
  set(foreign)
  foreach(other IN LISTS ARGN)
    list_files(${other} other_files)
    foreach(file IN LISTS other_files)
      get_filename_component(name "${file}" NAME)
      list(APPEND foreign "${name}")
    endforeach()
  endforeach()
  foreach(file IN LISTS files)
    file(STRINGS "${file}" includes REGEX "^[ \t]*#[ \t]*include")
    foreach(line IN LISTS includes)
      if(NOT line MATCHES "include[ \t]*[<\"]([^>\"]+)[>\"]")
        continue()
      endif()
      set(header "${CMAKE_MATCH_1}")
      get_filename_component(name "${header}" NAME)
      get_filename_component(own "${ROOT}/${folder}/${header}" ABSOLUTE)
      if(header MATCHES "^${pattern}" OR name MATCHES "^${pattern}" OR (name IN_LIST foreign AND NOT EXISTS "${own}"))
        file(RELATIVE_PATH shown "${ROOT}" "${file}")
        list(APPEND violations "${shown} includes ${header}")
      endif()
    endforeach()
  endforeach()
  set(violations "${violations}" PARENT_SCOPE)
endfunction()

list_files(Simulation simulation_files)
if(NOT simulation_files)
  message(FATAL_ERROR "No source file was found under ${ROOT}/Simulation.")
endif()

check(Simulation "(vtk|${qt})" Filters Plugin)
check(Filters "(${qt}|${volume_libraries})" Plugin)
check(Plugin "${volume_libraries}")

if(violations)
  list(JOIN violations "\n  " text)
  message(FATAL_ERROR "A floor may know only the floor beneath it:\n  ${text}")
endif()

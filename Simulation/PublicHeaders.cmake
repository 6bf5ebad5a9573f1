# Copies HEADERS (by comma) and what they include from SOURCE to INCLUDE/sono, where `#include "Trace/Trace.h"` becomes
# `#include <sono/Trace/Trace.h>`; removes what else lies there. Writes their names to LIST, for ninja the files that were
# read to LIST.d.
cmake_minimum_required(VERSION 3.25)

set(quoted "(#[ \t]*include[ \t]+)\"([^\"]+)\"")
string(REPLACE "," ";" queue "${HEADERS}")
set(headers)
while(queue)
  list(POP_FRONT queue header)
  if(header IN_LIST headers)
    continue()
  endif()
  list(APPEND headers "${header}")

  file(READ "${SOURCE}/${header}" text)
  string(REGEX MATCHALL "${quoted}" lines "${text}")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "${quoted}" "\\2" included "${line}")
    list(APPEND queue "${included}")
  endforeach()

  string(REGEX REPLACE "${quoted}" "\\1<sono/\\2>" text "${text}")
  set(copy "${INCLUDE}/sono/${header}")
  set(old)
  if(EXISTS "${copy}")
    file(READ "${copy}" old)
  endif()
  if(NOT text STREQUAL old) # an untouched copy stays as old as it is, for those who build against it
    file(WRITE "${copy}" "${text}")
  endif()
endwhile()

file(GLOB_RECURSE copies RELATIVE "${INCLUDE}/sono" "${INCLUDE}/sono/*")
foreach(copy IN LISTS copies)
  if(NOT copy IN_LIST headers)
    file(REMOVE "${INCLUDE}/sono/${copy}")
  endif()
endforeach()

list(SORT headers)
list(JOIN headers "\n" text)
file(WRITE "${LIST}" "${text}\n")
list(TRANSFORM headers PREPEND "${SOURCE}/")
list(TRANSFORM headers REPLACE " " "\\\\ ")
list(JOIN headers " " text)
string(REPLACE " " "\\ " target "${LIST}")
file(WRITE "${LIST}.d" "${target}: ${text}\n")

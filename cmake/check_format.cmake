# Checks that all C++ sources are formatted by clang-format 14 with .clang-format; other versions format differently.
#   cmake -P cmake/check_format.cmake
cmake_minimum_required(VERSION 3.21)

find_program(format NAMES clang-format-14)
if(NOT format)
  message("skipped: clang-format-14 is not installed")
  return()
endif()
get_filename_component(root ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)
set(patterns "")
foreach(folder IN ITEMS include tests benchmarks examples)
  list(APPEND patterns ${root}/${folder}/*.hpp ${root}/${folder}/*.ipp ${root}/${folder}/*.cpp)
endforeach()
file(GLOB_RECURSE files RELATIVE ${root} ${patterns})
list(FILTER files EXCLUDE REGEX "^examples/.*/build[^/]*/")  # an example may be built in its own folder
list(LENGTH files count)
if(count EQUAL 0)
  message(FATAL_ERROR "no sources below ${root}")
endif()
execute_process(COMMAND ${format} --dry-run -Werror ${files} WORKING_DIRECTORY ${root} RESULT_VARIABLE failed
                ERROR_VARIABLE differences)
if(failed)
  string(REGEX MATCHALL "[^\n]*: error:" places "${differences}")
  list(TRANSFORM places REPLACE "(.*): error:$" "  \\1")
  string(REPLACE ";" "\n" places "${places}")
  message(FATAL_ERROR "format these with clang-format-14 -i:\n${places}")
endif()
message(STATUS "format: ${count} files are formatted by .clang-format")

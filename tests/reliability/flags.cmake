# E9: one small program under many flags. Flags that remove the checks for NaN are refused by name; under all others it
# prints the same numbers, to the bound that the program itself knows.
#   cmake -DCOMPILER= -DINCLUDES= -DSYSTEM_INCLUDES= -DWORK= -P flags.cmake
cmake_minimum_required(VERSION 3.21)
include(${CMAKE_CURRENT_LIST_DIR}/../linking/compiler.cmake)
set(source ${CMAKE_CURRENT_LIST_DIR}/flags/main.cpp)

# build(<flags...>): compiles and links; `result` and `text` say what came of it.
macro(build)
  execute_process(COMMAND ${base} -w ${search} ${ARGN} ${source} -o ${WORK}/flags RESULT_VARIABLE result OUTPUT_VARIABLE text
                  ERROR_VARIABLE text)
endmacro()

foreach(flag -ffast-math -Ofast -ffinite-math-only)
  build(-O1 ${flag} -fsyntax-only -Wfatal-errors)
  if(result EQUAL 0 OR NOT text MATCHES "palpate refuses -ffast-math")
    message("${text}")
    message(FATAL_ERROR "${flag} is not refused")
  endif()
  message(STATUS "${flag}: refused")
endforeach()

set(sets "-O0" "-O2" "-O3 -fno-rtti" "-O1 -fno-exceptions -fno-rtti" "-O2 -ffp-contract=off")
cmake_host_system_information(RESULT processor QUERY OS_PLATFORM)
if(processor MATCHES "^(x86_64|AMD64|amd64)$")
  list(APPEND sets "-O2 -march=x86-64" "-O2 -march=native")
endif()
set(first "")
foreach(flags IN LISTS sets)
  separate_arguments(flag_list UNIX_COMMAND "${flags}")
  build(${flag_list})
  if(NOT result EQUAL 0)
    message("${text}")
    message(FATAL_ERROR "${flags}: does not build")
  endif()
  execute_process(COMMAND ${WORK}/flags ${first} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  message(STATUS "${flags}: ${text}")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${flags}: other numbers than with the first flags, ${first}")
  endif()
  if(first STREQUAL "")
    separate_arguments(first UNIX_COMMAND "${text}")
  endif()
endforeach()

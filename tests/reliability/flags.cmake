# E9: one small program under many flags. Flags that remove the checks for NaN are refused with a message that names
# them. The program compiles under all others; under those that change numbers most it prints the same numbers within
# the tolerance set in the program.
#   cmake -DCOMPILER= -DINCLUDES= -DSYSTEM_INCLUDES= -DWORK= -P flags.cmake
cmake_minimum_required(VERSION 3.21)
include(${CMAKE_CURRENT_LIST_DIR}/../linking/compiler.cmake)
set(source ${CMAKE_CURRENT_LIST_DIR}/flags/main.cpp)

# build(<flags...>): sets `result` (exit code) and `text` (messages).
macro(build)
  execute_process(COMMAND ${base} -w ${search} ${ARGN} ${source} -o ${WORK}/flags -pthread RESULT_VARIABLE result OUTPUT_VARIABLE text
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

set(x86 FALSE)
cmake_host_system_information(RESULT processor QUERY OS_PLATFORM)
if(processor MATCHES "^(x86_64|AMD64|amd64)$")
  set(x86 TRUE)
endif()

# Compiled only: these flags do not change numbers.
set(sets "-fno-rtti" "-fno-exceptions")
if(x86)
  list(APPEND sets "-march=x86-64-v3" "-march=x86-64-v4")
endif()
foreach(flags IN LISTS sets)
  build(-fsyntax-only ${flags})
  if(NOT result EQUAL 0)
    message("${text}")
    message(FATAL_ERROR "${flags}: does not compile")
  endif()
  message(STATUS "${flags}: compiles")
endforeach()

# Compiled and run: without optimisation; -O2 without exceptions; fused multiply-add and the widest vectors of this
# machine.
set(sets "-O0" "-O2 -fno-exceptions -fno-rtti -ffp-contract=off")
if(x86)
  list(APPEND sets "-O1 -march=native -ffp-contract=fast")
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
    message(FATAL_ERROR "${flags}: the numbers differ from those with the first flags, ${first}")
  endif()
  if(first STREQUAL "")
    separate_arguments(first UNIX_COMMAND "${text}")
  endif()
endforeach()

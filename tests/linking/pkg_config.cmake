# The same program without CMake: pkg-config and one line for the compiler.
cmake_minimum_required(VERSION 3.21)
find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message("SKIPPED: pkg-config is not installed (apt-get install pkg-config)")
  return()
endif()
execute_process(COMMAND ${PKG_CONFIG} --exists eigen3 RESULT_VARIABLE no_eigen)
if(no_eigen)
  message("SKIPPED: pkg-config does not know eigen3")
  return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/compiler.cmake)
set(search "")  # pkg-config says where the headers are, and nothing else

set(ENV{PKG_CONFIG_PATH} ${PREFIX}/share/pkgconfig)
foreach(what cflags libs)
  execute_process(COMMAND ${PKG_CONFIG} --${what} palpate RESULT_VARIABLE failed OUTPUT_VARIABLE ${what}
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(failed)
    message(FATAL_ERROR "pkg-config --${what} palpate failed")
  endif()
  separate_arguments(${what} UNIX_COMMAND "${${what}}")
endforeach()
must_succeed("it does not compile" ${base} ${cflags} ${CMAKE_CURRENT_LIST_DIR}/../consumer/main.cpp ${TISSUE_OBJECT}
             ${libs} -o stranger)
must_succeed("the force is not right" ${WORK}/stranger)

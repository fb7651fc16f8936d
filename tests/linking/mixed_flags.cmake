# Two sources of one program, compiled with the same flags, must link and run. With OTHER_FLAGS for one of them they
# must not link, and the linker must report both the function that takes a palpate type and the one that returns it as
# missing.
cmake_minimum_required(VERSION 3.21)
include(${CMAKE_CURRENT_LIST_DIR}/compiler.cmake)
set(folder ${CMAKE_CURRENT_LIST_DIR}/mixed_flags)
separate_arguments(OTHER_FLAGS NATIVE_COMMAND "${OTHER_FLAGS}")

compile(${folder}/main.cpp main.o)
compile(${folder}/scene.cpp scene.o)
link_program(alike main.o scene.o)
if(NOT result EQUAL 0)
  message("${text}")
  message(FATAL_ERROR "compiled with the same flags, they do not link")
endif()
must_succeed("compiled with the same flags, they do not run" ${WORK}/alike)

compile(${folder}/scene.cpp other.o ${OTHER_FLAGS})
link_program(mixed main.o other.o)
if(result EQUAL 0)
  message(FATAL_ERROR "compiled with and without ${OTHER_FLAGS} they link, but must not")
endif()
foreach(expect "make_scene.*v0_align" "add_gravity.*v0_align")
  if(NOT text MATCHES "undefined[^\n]*${expect}|undefined[^\n]*\n[^\n]*${expect}")
    message("${text}")
    message(FATAL_ERROR "they do not link, but the messages do not contain `undefined ... ${expect}`")
  endif()
endforeach()
message("${text}")

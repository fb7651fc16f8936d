# tests/consumer without CMake and without a library: two sources have all definitions of palpate, the others construct a
# model and tick. Without PALPATE_COMPILED the headers of the definitions must be refused.
cmake_minimum_required(VERSION 3.21)
include(${CMAKE_CURRENT_LIST_DIR}/compiler.cmake)
set(consumer ${CMAKE_CURRENT_LIST_DIR}/../consumer)

foreach(header source shipped_source)
  file(WRITE ${WORK}/${header}.cpp "#include <palpate/${header}.hpp>\n")
  execute_process(COMMAND ${base} ${search} -fsyntax-only ${WORK}/${header}.cpp RESULT_VARIABLE result
                  OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(result EQUAL 0 OR NOT text MATCHES "palpate/${header}.hpp needs -DPALPATE_COMPILED")
    message("${text}")
    message(FATAL_ERROR "${header}.hpp without PALPATE_COMPILED must be refused with a sentence that names the flag")
  endif()
endforeach()

compile(source.cpp source.o -DPALPATE_COMPILED)
compile(shipped_source.cpp shipped_source.o -DPALPATE_COMPILED)
compile(${consumer}/tissue.cpp tissue.o -DPALPATE_COMPILED)
compile(${consumer}/main.cpp main.o -DPALPATE_COMPILED)
link_program(stranger source.o shipped_source.o tissue.o main.o)
if(NOT result EQUAL 0)
  message("${text}")
  message(FATAL_ERROR "the program does not link")
endif()
must_succeed("the force is wrong" ${WORK}/stranger)

# Programs without exceptions: every header, and a tissue of every family of solvers, compile; in one that runs, valid
# set-up works, errors reach its handler, and it aborts without a handler.
#   cmake -DCOMPILER= -DINCLUDES= -DSYSTEM_INCLUDES= -DWORK= [-DXML_MESHES=ON] -P no_exceptions.cmake
cmake_minimum_required(VERSION 3.21)
include(${CMAKE_CURRENT_LIST_DIR}/compiler.cmake)

# g++ checks `try` in a template only where the template is used: every one follows the macro's guard. The C interface
# (c/) is a library of its own, which always has exceptions.
get_filename_component(tests ${CMAKE_CURRENT_LIST_DIR} DIRECTORY)
file(GLOB_RECURSE sources ${INCLUDES}/palpate/*.hpp ${INCLUDES}/palpate/*.ipp ${INCLUDES}/palpate/*.tpp)
list(FILTER sources EXCLUDE REGEX "/palpate/c/")
set(all_headers "#include \"device/fakes/hd.hpp\"\n#include \"device/fakes/dhdc.hpp\"\n")  # before adapters of SDKs
foreach(source IN LISTS sources)
  file(READ ${source} text)
  string(REGEX REPLACE "#if defined\\(PALPATE_HAS_EXCEPTIONS\\)\n *try {" "" text "${text}")
  if(text MATCHES "\n *try {")
    message(FATAL_ERROR "${source}: `try` without `#if defined(PALPATE_HAS_EXCEPTIONS)` before it; core/detail/attempt.hpp has functions for it")
  endif()
  if(source MATCHES "/(shipped_)?source\\.hpp$")  # definitions, of palpate::compiled
    continue()
  endif()
  if(source MATCHES "\\.hpp$" AND (XML_MESHES OR NOT source MATCHES "/io/xml/"))
    file(RELATIVE_PATH name ${INCLUDES} ${source})
    string(APPEND all_headers "#include <${name}>\n")
  endif()
endforeach()
file(WRITE ${WORK}/all_headers.hpp "${all_headers}")
must_succeed("families.cpp does not compile" ${base} ${search} -I${tests} -I${WORK} -fno-exceptions -fno-rtti -fsyntax-only
             ${CMAKE_CURRENT_LIST_DIR}/no_exceptions/families.cpp)

compile(${CMAKE_CURRENT_LIST_DIR}/no_exceptions/main.cpp main.o -fno-exceptions -fno-rtti)
link_program(no_exceptions main.o)
if(NOT result EQUAL 0)
  message("${text}")
  message(FATAL_ERROR "the program does not link")
endif()

# expect(<argument> <exit code, or a signal's name> <text that must be printed>)
function(expect argument code expected)
  execute_process(COMMAND ${WORK}/no_exceptions ${argument} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  message("${argument}: ${result}\n${text}")
  if(NOT result MATCHES "^(${code})$" OR NOT text MATCHES "${expected}")
    message(FATAL_ERROR "${argument}: expected ${code} and `${expected}`")
  endif()
endfunction()
expect(valid 0 "force 0\\.")
expect(invalid 7 "handler: bad_poisson_ratio, value 0\\.5, threshold 0\\.5")
expect(inverted 7 "handler: inverted_element, .*count 1, ids 3")
expect(default "134|Subprocess aborted|Abort.*|SIGABRT.*" "palpate: bad_poisson_ratio: ")
expect(returns "134|Subprocess aborted|Abort.*|SIGABRT.*" "handler: bad_poisson_ratio.*palpate: bad_poisson_ratio: ")

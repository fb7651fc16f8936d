# cmake -DROOT= -DSOURCE= -P extract.cmake: writes every C++ block of README.md and the pages of docs into one source,
# each as a function of its own (a block with main: as a namespace), with its lines numbered as in the page.
#
# A block may be preceded by <!-- context: ... -->, C++ that a reader has written before: it opens the function. What
# most blocks share, such as `mesh`, `scene`, `organ` and `session`, is in context.hpp.
cmake_minimum_required(VERSION 3.21)

file(GLOB_RECURSE pages RELATIVE ${ROOT} ${ROOT}/docs/*.md)
list(FILTER pages EXCLUDE REGEX "^docs/results/")
list(PREPEND pages README.md)

set(includes "")
set(functions "")
set(blocks 0)
foreach(page IN LISTS pages)
  file(READ ${ROOT}/${page} rest)
  set(line 1)
  while(TRUE)
    string(FIND "${rest}" "```cpp\n" start)
    if(start EQUAL -1)
      break()
    endif()
    string(SUBSTRING "${rest}" 0 ${start} before)
    math(EXPR start "${start} + 7")
    string(SUBSTRING "${rest}" ${start} -1 rest)
    string(FIND "${rest}" "\n```" end)
    if(end EQUAL -1)
      message(FATAL_ERROR "${page}: a block of C++ does not end")
    endif()
    string(SUBSTRING "${rest}" 0 ${end} code)
    string(SUBSTRING "${rest}" ${end} -1 rest)

    string(REGEX MATCHALL "\n" ends "${before}")
    list(LENGTH ends ends)
    math(EXPR line "${line} + ${ends} + 1")
    set(first ${line})
    string(REGEX MATCHALL "\n" ends "${code}")
    list(LENGTH ends ends)
    math(EXPR line "${line} + ${ends}")

    set(context "")
    if(before MATCHES "<!-- context: (([^>]|[^-]>)*) -->\n$")
      set(context "${CMAKE_MATCH_1}")
    endif()
    string(REGEX MATCHALL "#(include|define) [^\n]*" some "${code}")
    # Definitions of templates matter when a program links, and would double the time.
    list(FILTER some EXCLUDE REGEX "own_types")
    list(JOIN some "\n" some)
    string(APPEND includes "${some}\n")
    string(REGEX REPLACE "#(include|define) [^\n]*" "" code "${code}")
    string(REGEX REPLACE "\nusing namespace palpate;" "\n" code "${code}")

    math(EXPR blocks "${blocks} + 1")
    if(code MATCHES "int main\\(")
      string(APPEND functions "namespace block_${blocks} {\n#line ${first} \"${ROOT}/${page}\"\n${code}\n}\n")
    else()
      set(place "#line ${first} \"${ROOT}/${page}\"")
      string(APPEND functions "void block_${blocks}() {\n${place}\n${context}\n{\n${place}\n${code}\n}\n}\n")
    endif()
  endwhile()
endforeach()

if(blocks LESS 20)
  message(FATAL_ERROR "only ${blocks} blocks of C++ were found in the pages")
endif()
file(WRITE ${SOURCE} "// Made of the pages by tests/docs/extract.cmake.\n#include \"context.hpp\"\n${includes}\n"
                     "using namespace page;\n${functions}")
message(STATUS "docs: ${blocks} blocks of C++ in ${SOURCE}")

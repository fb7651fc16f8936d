# The messages that compile.cmake stored in WORK for SOURCE must be a refusal with the text that SOURCE expects.
#   cmake -DSOURCE= -DWORK= -P check.cmake
cmake_minimum_required(VERSION 3.21)

file(READ ${SOURCE} text)
if(NOT text MATCHES "// expect: *([^\n]*[^ \r\n])")
  message(FATAL_ERROR "${SOURCE}: needs a line `// expect: <text of the compiler's message>`")
endif()
set(expect "${CMAKE_MATCH_1}")
get_filename_component(name ${SOURCE} NAME_WE)

file(READ ${WORK}/good.txt good)
if(NOT good STREQUAL "")  # one that fails may hide errors of the others, so all fail
  message("${good}")
  message(FATAL_ERROR "the good twins do not compile")
endif()
if(NOT EXISTS ${WORK}/${name}.txt)
  message(FATAL_ERROR "it compiles but must not (all messages: ${WORK}/messages.txt)")
endif()
file(READ ${WORK}/${name}.txt bad)
string(FIND "${bad}" "${expect}" found)
if(found EQUAL -1)
  message("${bad}")
  message(FATAL_ERROR "it is refused, but the messages do not contain `${expect}`")
endif()
message(STATUS "refused as expected: ${expect}")

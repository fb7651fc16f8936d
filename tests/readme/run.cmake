# cmake -DPROGRAM= -DFOLDER= -P run.cmake: the program of the README must exit with 0 and render a force.
cmake_minimum_required(VERSION 3.21)

execute_process(COMMAND ${PROGRAM} WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result
                OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the program of the README ended with ${result}")
endif()
if(NOT output MATCHES "set-up: [0-9]+ nodes" OR NOT output MATCHES "haptic loop: [0-9]+ ticks")
  message(FATAL_ERROR "a report is missing")
endif()
if(NOT output MATCHES "peak force ([0-9.]+) N" OR NOT CMAKE_MATCH_1 GREATER 0)
  message(FATAL_ERROR "the program rendered no force")
endif()

# Shared by scripts that call the compiler: compile() and link_program() run in WORK, with COMPILER, FLAGS, INCLUDES and
# SYSTEM_INCLUDES.
set(ENV{LC_ALL} C)  # ASCII quotes in the compiler's messages
separate_arguments(FLAGS NATIVE_COMMAND "${FLAGS}")
set(base ${COMPILER} -std=c++20 ${FLAGS} -O0)
set(search "")
foreach(folder IN LISTS INCLUDES)
  list(APPEND search -I${folder})
endforeach()
foreach(folder IN LISTS SYSTEM_INCLUDES)
  list(APPEND search -isystem ${folder})
endforeach()
file(MAKE_DIRECTORY ${WORK})

function(must_succeed what)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT result EQUAL 0)
    message("${text}")
    message(FATAL_ERROR "${what}: ${result}")
  endif()
endfunction()

function(compile source object)  # further flags follow
  must_succeed("${source} does not compile" ${base} ${search} ${ARGN} -c ${source} -o ${object})
endfunction()

# Sets `result` and `text`, the linker's messages.
function(link_program program)  # objects follow
  execute_process(COMMAND ${base} ${ARGN} -o ${program} -pthread WORKING_DIRECTORY ${WORK}
                  RESULT_VARIABLE code OUTPUT_VARIABLE messages ERROR_VARIABLE messages)
  set(result ${code} PARENT_SCOPE)
  set(text "${messages}" PARENT_SCOPE)
endfunction()

# Installs palpate from its build folder BUILD, and moves it to PREFIX: installed files must not depend on their
# location.
cmake_minimum_required(VERSION 3.21)
file(REMOVE_RECURSE ${PREFIX} ${PREFIX}-first)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX}-first RESULT_VARIABLE result OUTPUT_QUIET)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the installation failed: ${result}")
endif()
file(RENAME ${PREFIX}-first ${PREFIX})

# All headers must be installed, and no file may contain a path of the build machine.
file(GLOB_RECURSE headers RELATIVE ${SOURCE}/include ${SOURCE}/include/palpate/*.hpp
     ${SOURCE}/include/palpate/*.ipp)
list(FILTER headers EXCLUDE REGEX "^palpate/c/")
foreach(header IN LISTS headers)
  if(NOT EXISTS ${PREFIX}/include/${header})
    message(FATAL_ERROR "${header} is not installed")
  endif()
endforeach()
file(GLOB_RECURSE files ${PREFIX}/*.cmake ${PREFIX}/*.pc)
foreach(file IN LISTS files)
  file(READ ${file} text)
  foreach(folder ${SOURCE} ${BUILD} ${PREFIX})
    # As an absolute path: the sources may be in /palpate, and files contain cmake/palpate.
    string(REGEX REPLACE "([][+.*()^$?|\\])" "\\\\\\1" pattern "${folder}")
    if(text MATCHES "(^|[^A-Za-z0-9_./}-]|-I|-L)${pattern}(/|[^A-Za-z0-9_./-]|$)")
      message(FATAL_ERROR "${file} contains the path ${folder}")
    endif()
  endforeach()
endforeach()

# Configures, builds and runs tests/consumer, getting palpate in the way WAY, and linking LIBRARY (palpate::palpate when it
# is empty). TISSUE_OBJECT: its other object is already here. Needs GENERATOR, COMPILER, FLAGS, WORK, SOURCE (of palpate), PREFIX (where it is installed) and EIGEN_DIR.
cmake_minimum_required(VERSION 3.21)

function(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  message("${text}")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what}: ${result}")
  endif()
endfunction()

if(WAY STREQUAL "find_package")
  set(way -DCMAKE_PREFIX_PATH=${PREFIX})
elseif(WAY STREQUAL "add_subdirectory")
  set(way -DPALPATE_SOURCE=${SOURCE})
else()
  set(way -DFETCHCONTENT_SOURCE_DIR_PALPATE=${SOURCE})
endif()
if(LIBRARY)
  list(APPEND way -DPALPATE_TARGET=${LIBRARY})
endif()
if(TISSUE_OBJECT)
  list(APPEND way -DTISSUE_OBJECT=${TISSUE_OBJECT})
endif()

file(REMOVE_RECURSE ${WORK})
step("it does not configure" ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/../consumer -B ${WORK} -G ${GENERATOR}
     -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE= -DGET_PALPATE=${WAY}
     -DEigen3_DIR=${EIGEN_DIR} ${way})
step("it does not build" ${CMAKE_COMMAND} --build ${WORK})
step("the force is not right" ${WORK}/stranger)

# An installed palpate must be the one that is used.
if(WAY STREQUAL "find_package")
  file(STRINGS ${WORK}/CMakeCache.txt found REGEX "^palpate_DIR:")
  if(NOT found MATCHES "=${PREFIX}/")
    message(FATAL_ERROR "${found} is not below ${PREFIX}")
  endif()
endif()

# Who links no library builds none.
if(NOT "${LIBRARY}" STREQUAL "palpate::compiled")
  file(GLOB_RECURSE built ${WORK}/*palpate_compiled.*)
  list(FILTER built INCLUDE REGEX "\\.(a|so|dylib)$")
  if(built)
    message(FATAL_ERROR "${built} was built, and nobody links it")
  endif()
endif()

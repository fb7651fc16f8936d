# Configures, builds and runs tests/consumer, which obtains palpate by METHOD and links LIBRARY (palpate::palpate when
# it is empty). TISSUE_OBJECT: object of tissue.cpp that is already compiled. Needs GENERATOR, COMPILER, FLAGS, WORK,
# SOURCE (of palpate), PREFIX (where it is installed) and EIGEN_DIR.
cmake_minimum_required(VERSION 3.21)

include(${CMAKE_CURRENT_LIST_DIR}/step.cmake)

if(METHOD STREQUAL "find_package")
  set(method_arguments -DCMAKE_PREFIX_PATH=${PREFIX})
elseif(METHOD STREQUAL "add_subdirectory")
  set(method_arguments -DPALPATE_SOURCE=${SOURCE})
else()
  set(method_arguments -DFETCHCONTENT_SOURCE_DIR_PALPATE=${SOURCE})
endif()
if(LIBRARY)
  list(APPEND method_arguments -DPALPATE_TARGET=${LIBRARY})
endif()
if(TISSUE_OBJECT)
  list(APPEND method_arguments -DTISSUE_OBJECT=${TISSUE_OBJECT})
endif()

file(REMOVE_RECURSE ${WORK})
step("the consumer does not configure" ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/../consumer -B ${WORK}
     -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE=
     -DGET_PALPATE=${METHOD} -DEigen3_DIR=${EIGEN_DIR} ${method_arguments})
step("the consumer does not build" ${CMAKE_COMMAND} --build ${WORK})
step("the force is wrong" ${WORK}/stranger)

# find_package must use the installed palpate.
if(METHOD STREQUAL "find_package")
  file(STRINGS ${WORK}/CMakeCache.txt found REGEX "^palpate_DIR:")
  if(NOT found MATCHES "=${PREFIX}/")
    message(FATAL_ERROR "${found} is not below ${PREFIX}")
  endif()
endif()

# Without the compiled target, no library is built.
if(NOT "${LIBRARY}" STREQUAL "palpate::compiled")
  file(GLOB_RECURSE built ${WORK}/*palpate_compiled.*)
  list(FILTER built INCLUDE REGEX "\\.(a|so|dylib)$")
  if(built)
    message(FATAL_ERROR "${built} was built, but nothing links it")
  endif()
endif()

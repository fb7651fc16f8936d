# Builds and runs the project xml_meshes with the installed palpate::xml_meshes, and with palpate::compiled if COMPILED.
# Its files need zlib and pugixml. Needs GENERATOR, COMPILER, FLAGS, WORK, SOURCE (of palpate), PREFIX (where it is
# installed) and EIGEN_DIR.
cmake_minimum_required(VERSION 3.21)

include(${CMAKE_CURRENT_LIST_DIR}/step.cmake)

file(REMOVE_RECURSE ${WORK})
step("it does not configure" ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/xml_meshes -B ${WORK} -G ${GENERATOR}
     -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE= -DCOMPILED=${COMPILED}
     -DCMAKE_PREFIX_PATH=${PREFIX} -DEigen3_DIR=${EIGEN_DIR})
step("it does not build" ${CMAKE_COMMAND} --build ${WORK})
set(seeds ${SOURCE}/tests/fuzz/seeds)
step("it reads other meshes" ${WORK}/reader ${seeds}/vtu/vtu_base64_zlib_64 ${seeds}/febio/febio_4.0)

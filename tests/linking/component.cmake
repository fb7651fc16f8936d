# find_package(palpate COMPONENTS compiled) where only headers are installed: it must fail with the cause and the
# remedy; without the component it must find the headers. Needs GENERATOR, COMPILER, WORK, PREFIX and EIGEN_DIR.
cmake_minimum_required(VERSION 3.21)
file(REMOVE_RECURSE ${WORK})
file(COPY ${PREFIX}/include ${PREFIX}/share DESTINATION ${WORK}/installed)
file(WRITE ${WORK}/CMakeLists.txt "cmake_minimum_required(VERSION 3.21)
project(stranger LANGUAGES CXX)
find_package(palpate REQUIRED \${components})
if(NOT TARGET palpate::palpate OR TARGET palpate::compiled)
  message(FATAL_ERROR \"other targets than expected\")
endif()
")
# configure(<further arguments>): sets result and text.
macro(configure)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
                          -DCMAKE_PREFIX_PATH=${WORK}/installed -DEigen3_DIR=${EIGEN_DIR} ${ARGN}
                  RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
endmacro()

configure()
if(NOT result EQUAL 0)
  message("${text}")
  message(FATAL_ERROR "palpate is not found without components")
endif()
configure("-Dcomponents=COMPONENTS\\;compiled")
string(REGEX REPLACE "[ \n]+" " " text "${text}")
if(result EQUAL 0 OR NOT text MATCHES "installed without the component 'compiled'")
  message("${text}")
  message(FATAL_ERROR "a missing component must be refused, and the message must name it")
endif()

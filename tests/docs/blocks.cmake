# Checks that the C++ blocks of README.md and docs compile, all in one source, with fakes in place of vendors' headers.
# Messages name the line of the page.
cmake_minimum_required(VERSION 3.21)
set(INCLUDES ${WORK}/sdk ${ROOT}/include ${ROOT}/tests ${ROOT}/tests/docs)
include(${CMAKE_CURRENT_LIST_DIR}/../linking/compiler.cmake)

file(WRITE ${WORK}/sdk/dhdc.h "#include \"device/fakes/dhdc.hpp\"\n")
file(WRITE ${WORK}/sdk/HD/hd.h "#include \"device/fakes/hd.hpp\"\n")
set(source ${WORK}/blocks.cpp)
must_succeed("the blocks cannot be extracted" ${CMAKE_COMMAND} -DROOT=${ROOT} -DSOURCE=${source}
             -P ${CMAKE_CURRENT_LIST_DIR}/extract.cmake)
must_succeed("a block of the pages does not compile" ${base} ${search} -DPALPATE_COMPILED -w -fsyntax-only ${source})

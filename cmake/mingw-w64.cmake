# Toolchain file: programs for 64-bit Windows from a Debian or Ubuntu machine, run under wine if it is installed.
#   apt-get install g++-mingw-w64-x86-64-posix wine64
#   cmake -S . -B build/windows -DCMAKE_TOOLCHAIN_FILE=cmake/mingw-w64.cmake
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
# The compiler with POSIX threads: the other one has no std::thread before GCC 13.
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)

# Libraries of the host cannot be used for Windows; its header-only libraries can, but not with all of /usr/include:
# they get a separate folder and packages. Catch2 must be v2 for that.
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
get_property(trying GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT trying)
  set(headers ${CMAKE_BINARY_DIR}/headers_of_host)
  foreach(package "catch2;Catch2;Catch2::Catch2" "nlohmann;nlohmann_json;nlohmann_json::nlohmann_json")
    list(GET package 0 folder)
    list(GET package 1 name)
    list(GET package 2 target)
    if(EXISTS /usr/include/${folder})
      file(MAKE_DIRECTORY ${headers})
      file(CREATE_LINK /usr/include/${folder} ${headers}/${folder} SYMBOLIC)
      file(WRITE ${headers}/${name}Config.cmake
           "add_library(${target} INTERFACE IMPORTED)\ntarget_include_directories(${target} SYSTEM INTERFACE ${headers})\n")
      set(${name}_DIR ${headers})
    endif()
  endforeach()
endif()

# One self-contained executable. Without -Wa,-mbig-obj Eigen's templates need too many sections for an object file.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CXX_FLAGS_INIT -Wa,-mbig-obj)

find_program(PALPATE_WINE NAMES wine64 wine)
if(PALPATE_WINE)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${PALPATE_WINE})
endif()

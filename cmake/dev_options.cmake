# palpate_dev_options: what palpate's own tests, examples and benchmarks are compiled with. Users never get it.
add_library(palpate_dev_options INTERFACE)

if(MSVC)
  target_compile_options(palpate_dev_options INTERFACE /W4 /bigobj /utf-8 $<$<BOOL:${PALPATE_WERROR}>:/WX>)
  return()
endif()

# clang counts -Wsign-conversion into -Wconversion and g++ does not: off, so that both see the same rules.
target_compile_options(palpate_dev_options INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms: on std::string (GCC bug 105651); on std::variant, and on g++'s own AVX-512 intrinsics (105593).
  target_compile_options(palpate_dev_options INTERFACE -Wno-restrict -Wno-maybe-uninitialized -Wno-uninitialized)
endif()
if(PALPATE_WERROR)
  target_compile_options(palpate_dev_options INTERFACE -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # flow analysis after inlining Eigen: too many false alarms to stop a build
    target_compile_options(palpate_dev_options INTERFACE -Wno-error=maybe-uninitialized -Wno-error=array-bounds
                                                         -Wno-error=stringop-overflow -Wno-error=stringop-overread)
  endif()
endif()

if(PALPATE_NATIVE)
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-march=native PALPATE_HAS_MARCH_NATIVE)
  if(PALPATE_HAS_MARCH_NATIVE)
    target_compile_options(palpate_dev_options INTERFACE -march=native)
  endif()
endif()

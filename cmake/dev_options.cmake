# palpate_dev_options: compile options of palpate's own tests, examples and benchmarks. Not used for other projects.
add_library(palpate_dev_options INTERFACE)

if(MSVC)
  target_compile_options(palpate_dev_options INTERFACE /W4 /bigobj /utf-8 $<$<BOOL:${PALPATE_WERROR}>:/WX>)
  return()
endif()

# clang includes -Wsign-conversion in -Wconversion and g++ does not: off, so that both apply the same rules.
target_compile_options(palpate_dev_options INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False positives: on std::string (GCC bug 105651); on std::variant, and on g++'s own AVX-512 intrinsics (105593).
  target_compile_options(palpate_dev_options INTERFACE -Wno-restrict -Wno-maybe-uninitialized -Wno-uninitialized)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ collects garbage whenever its memory has doubled since 128 MiB. From 1 GiB on, a tenth to a quarter less compile
  # time; sources with the most templates, which decide how much memory a build needs, take 0.4 GiB more.
  target_compile_options(palpate_dev_options INTERFACE "SHELL:--param ggc-min-heapsize=1000000")
endif()
if(PALPATE_WERROR)
  target_compile_options(palpate_dev_options INTERFACE -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # flow analysis after inlining Eigen: too many false positives for errors
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

# palpate::compiled: the definitions of include/palpate (files .ipp) and explicit instantiations (x.inst.ipp),
# compiled once. Its sources are generated here, one per unit, which includes the definitions of the unit.

# <unit> <patterns of files below include/palpate, separated by spaces>. A file belongs to the first unit with a
# matching pattern, otherwise to a unit with the name of its room. Divide a large room into several units to compile it
# on several processors; small functions called in a tick should be in one unit, so that they are inlined.
set(palpate_units
  "contact_haptic contact/* haptic/*"  # one tick runs through both
  # Half the time of such a small room is spent on its headers.
  "base assembly/* concepts/* condensation/* core/* device/* element/* integrator/* local/* material/* post/* quadrature/*"
  "model_advice model/static/suggest.ipp model/static/detail/candidate_maker.ipp"
  "shipped_tetrahedra model/shipped/*tet*"
  "shipped_hexahedra model/shipped/*hex*")

include(${CMAKE_CURRENT_LIST_DIR}/not_compiled.cmake)

# PALPATE_COMPILED_WITHOUT: a pattern of units that a program does not use, for a build of that program only, which then
# takes less time; not for an installation.
set(PALPATE_COMPILED_WITHOUT "" CACHE STRING "Pattern of units of palpate::compiled that are left out")

set(left "")
set(sources "")
# palpate_source(<unit> <files>): a source that includes them; rewritten only when it changes.
function(palpate_source unit)
  if(PALPATE_COMPILED_WITHOUT AND unit MATCHES "${PALPATE_COMPILED_WITHOUT}")
    return()
  endif()
  set(source ${PROJECT_BINARY_DIR}/compiled/${unit}.cpp)
  list(TRANSFORM ARGN REPLACE "(.+)" "#include <palpate/\\1>\n" OUTPUT_VARIABLE lines)
  string(CONCAT lines ${lines})
  file(CONFIGURE OUTPUT ${source} CONTENT "${lines}" @ONLY)
  set(sources ${sources} ${source} PARENT_SCOPE)
endfunction()

foreach(file IN LISTS palpate_definitions)
  file(RELATIVE_PATH file ${PROJECT_SOURCE_DIR}/include/palpate ${file})
  if(NOT file MATCHES "${palpate_not_compiled}")
    list(APPEND left ${file})
  endif()
endforeach()
foreach(unit IN LISTS palpate_units)
  string(REPLACE " " ";" patterns ${unit})
  list(POP_FRONT patterns unit)
  set(taken "")
  foreach(pattern IN LISTS patterns)
    string(REPLACE "." "\\." pattern ${pattern})
    string(REPLACE "*" ".*" pattern ${pattern})
    set(matches ${left})
    list(FILTER matches INCLUDE REGEX "^${pattern}$")
    list(APPEND taken ${matches})
    list(FILTER left EXCLUDE REGEX "^${pattern}$")
  endforeach()
  if(taken)
    palpate_source(${unit} ${taken})
  endif()
endforeach()
list(TRANSFORM left REPLACE "/.*" "" OUTPUT_VARIABLE rooms)
list(REMOVE_DUPLICATES rooms)
foreach(room IN LISTS rooms)
  set(taken ${left})
  list(FILTER taken INCLUDE REGEX "^${room}/")
  palpate_source(${room} ${taken})
endforeach()

# The dense kernels of the solvers, those of explicit neo-Hookean forces and those of contact are compiled for other
# processors too, and chosen at run time (linear/detail/processor_kernels.hpp, assembly/detail/tetrahedron_kernels.hpp,
# contact/detail/contact_kernels.hpp). At least
# -O2, so that functions of Eigen and the standard library are inlined: the linker could choose a copy of one that is
# compiled for AVX for the whole program. Not on Windows, where g++ does not align the stack for AVX.
set(kernel_sources "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" AND NOT WIN32
   AND NOT CMAKE_OSX_ARCHITECTURES)
  foreach(flags IN ITEMS "avx2 -mavx2 -mfma" "avx512 -mavx2 -mfma -mavx512f -mavx512dq -mavx512vl")
    string(REPLACE " " ";" flags ${flags})
    list(POP_FRONT flags name)
    set(source ${PROJECT_BINARY_DIR}/compiled/kernels_${name}.cpp)
    file(CONFIGURE OUTPUT ${source} @ONLY CONTENT "#define PALPATE_KERNEL_SET _${name}
#include <palpate/assembly/detail/tetrahedron_kernels_here.hpp>
#include <palpate/contact/detail/contact_kernels_here.hpp>
#include <palpate/linear/detail/kernels_here.hpp>
const palpate::any_flags::Kernels palpate::any_flags::kernels_${name} = palpate::detail::kernels_here;
const palpate::any_flags::TetrahedronKernels palpate::any_flags::tetrahedra_${name} = palpate::detail::tetrahedra_here;
const palpate::any_flags::ContactKernels palpate::any_flags::contacts_${name} = palpate::detail::contacts_here;
")
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-O2;${flags}")
    list(APPEND kernel_sources ${source})
  endforeach()
endif()

if(NOT sources)
  palpate_source(nothing version.hpp)
endif()

list(JOIN sources "\n" lines)
file(WRITE ${PROJECT_BINARY_DIR}/compiled/units.txt "${lines}\n")  # for sh cmake/run compile-time

# Static unless BUILD_SHARED_LIBS is set. As part of another project, or if PALPATE_BUILD_COMPILED is off, it is built
# only when a target links it.
add_library(palpate_compiled ${sources} ${kernel_sources})
add_library(palpate::compiled ALIAS palpate_compiled)
if(NOT PALPATE_BUILD_COMPILED)
  set_target_properties(palpate_compiled PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
set_target_properties(palpate_compiled PROPERTIES EXPORT_NAME compiled VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} WINDOWS_EXPORT_ALL_SYMBOLS ON CXX_EXTENSIONS OFF)
target_compile_definitions(palpate_compiled PUBLIC PALPATE_COMPILED)
if(kernel_sources)
  target_compile_definitions(palpate_compiled PRIVATE PALPATE_KERNELS_BY_PROCESSOR)
endif()
target_link_libraries(palpate_compiled PUBLIC palpate)
# The including project may hide symbols by default; these are the interface of the library.
set_target_properties(palpate_compiled PROPERTIES CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
# g++ -fPIC would call the library's functions through a table, in case they are replaced: no inlining in the tick.
target_compile_options(palpate_compiled PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
if(TARGET palpate_dev_options)  # warnings, and the target processor of palpate's own programs
  target_compile_options(palpate_compiled PRIVATE $<TARGET_PROPERTY:palpate_dev_options,INTERFACE_COMPILE_OPTIONS>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False positives (g++ 12 and 14): loops of Eigen over vectors of eight that are never executed, as the matrices of
    # Hex8 and of single elements have fewer rows.
    target_compile_options(palpate_compiled PRIVATE -Wno-array-bounds)
  endif()
endif()

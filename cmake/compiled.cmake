# palpate::compiled: the definitions of include/palpate (x.ipp next to x.hpp), compiled once. Its sources are generated
# here: one per unit, which includes the definitions of the unit, and one per x.inst.ipp (explicit instantiations).

# <unit> <patterns of files below include/palpate, separated by spaces>. A file belongs to the first unit with a
# matching pattern, otherwise to a unit with the name of its room. Divide a large room into several units to compile it
# on several processors; small functions called in a tick should be in one unit, so that they are inlined.
set(palpate_units
  "contact_haptic contact/* haptic/*")  # one tick runs through both

# Adapters of SDKs must be included after the header of the SDK, in the program that uses it.
set(palpate_units_exclude "^device/(openhaptics|force_dimension|chai3d)\\.")

set(left "")
set(sources "")
# palpate_source(<unit> <files>): a source that includes them; rewritten only when it changes.
function(palpate_source unit)
  set(source ${PROJECT_BINARY_DIR}/compiled/${unit}.cpp)
  list(TRANSFORM ARGN REPLACE "(.+)" "#include <palpate/\\1>\n" OUTPUT_VARIABLE lines)
  string(CONCAT lines ${lines})
  file(CONFIGURE OUTPUT ${source} CONTENT "${lines}" @ONLY)
  set(sources ${sources} ${source} PARENT_SCOPE)
endfunction()

foreach(file IN LISTS palpate_definitions)
  file(RELATIVE_PATH file ${PROJECT_SOURCE_DIR}/include/palpate ${file})
  if(file MATCHES ${palpate_units_exclude})
    continue()
  elseif(file MATCHES "^(.+)\\.inst\\.ipp$")
    string(REPLACE "/" "_" unit ${CMAKE_MATCH_1})
    palpate_source(${unit}_inst ${file})
  else()
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

if(NOT sources)
  palpate_source(nothing version.hpp)
endif()

list(JOIN sources "\n" lines)
file(WRITE ${PROJECT_BINARY_DIR}/compiled/units.txt "${lines}\n")  # for sh cmake/run compile-time

# Static unless BUILD_SHARED_LIBS is set. As part of another project, or if PALPATE_BUILD_COMPILED is off, it is built
# only when a target links it.
add_library(palpate_compiled ${sources})
add_library(palpate::compiled ALIAS palpate_compiled)
if(NOT PALPATE_BUILD_COMPILED)
  set_target_properties(palpate_compiled PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
set_target_properties(palpate_compiled PROPERTIES EXPORT_NAME compiled VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} WINDOWS_EXPORT_ALL_SYMBOLS ON CXX_EXTENSIONS OFF)
target_compile_definitions(palpate_compiled PUBLIC PALPATE_COMPILED)
target_link_libraries(palpate_compiled PUBLIC palpate)
# The including project may hide symbols by default; these are the interface of the library.
set_target_properties(palpate_compiled PROPERTIES CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
# g++ -fPIC would call the library's functions through a table, in case they are replaced: no inlining in the tick.
target_compile_options(palpate_compiled PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
if(TARGET palpate_dev_options)  # warnings, and the target processor of palpate's own programs
  target_compile_options(palpate_compiled PRIVATE $<TARGET_PROPERTY:palpate_dev_options,INTERFACE_COMPILE_OPTIONS>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False positives: loops of Eigen over vectors of eight that are never executed for the vectors of four of Hex8.
    target_compile_options(palpate_compiled PRIVATE -Wno-array-bounds)
  endif()
endif()

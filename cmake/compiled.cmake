# palpate::compiled: the definitions of include/palpate (x.ipp beside x.hpp), compiled once. Its sources are made here:
# one per unit, which includes the unit's definitions, and one per x.inst.ipp (explicit instantiations).

# <unit> <patterns of files below include/palpate, separated by spaces>. A file goes to the first unit that takes it;
# what none takes goes to a unit named like its room. Give a big room several units to compile it on several processors;
# small functions that one tick calls should share a unit, so that they are inlined.
set(palpate_units
  "contact_haptic contact/* haptic/*")  # one tick runs through both

# Adapters of SDKs come after the SDK's own header, in the program that has it.
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

# Static, or what BUILD_SHARED_LIBS says. Where it is a guest's, or not wanted, it is built when somebody links it.
add_library(palpate_compiled ${sources})
add_library(palpate::compiled ALIAS palpate_compiled)
if(NOT PALPATE_BUILD_COMPILED)
  set_target_properties(palpate_compiled PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
set_target_properties(palpate_compiled PROPERTIES EXPORT_NAME compiled VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} WINDOWS_EXPORT_ALL_SYMBOLS ON CXX_EXTENSIONS OFF)
target_compile_definitions(palpate_compiled PUBLIC PALPATE_COMPILED)
target_link_libraries(palpate_compiled PUBLIC palpate)
# A guest may hide symbols; these are the library's interface.
set_target_properties(palpate_compiled PROPERTIES CXX_VISIBILITY_PRESET default VISIBILITY_INLINES_HIDDEN OFF)
# g++ -fPIC would call its own functions through a table, in case somebody replaces them: no inlining on the tick.
target_compile_options(palpate_compiled PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
if(TARGET palpate_dev_options)  # warnings, and the processor that palpate's own programs are for
  target_compile_options(palpate_compiled PRIVATE $<TARGET_PROPERTY:palpate_dev_options,INTERFACE_COMPILE_OPTIONS>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False alarms: vectors of eight in loops of Eigen that run no time on the fours of Hex8.
    target_compile_options(palpate_compiled PRIVATE -Wno-array-bounds)
  endif()
endif()

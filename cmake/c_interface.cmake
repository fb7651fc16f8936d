# libpalpate_c: the C interface (include/palpate/c/palpate.h), a shared library with palpate::compiled inside. Its
# sources are generated here, one per definition file of include/palpate/c/detail.
file(GLOB files CONFIGURE_DEPENDS include/palpate/c/detail/*.ipp)
set(sources "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME)
  string(REGEX REPLACE "\\.ipp$" "" unit ${name})
  string(REPLACE "." "_" unit ${unit})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/c_interface/${unit}.cpp CONTENT "#include <palpate/c/detail/${name}>\n")
  list(APPEND sources ${PROJECT_BINARY_DIR}/c_interface/${unit}.cpp)
endforeach()

add_library(palpate_c_objects OBJECT ${sources})
set_target_properties(palpate_c_objects PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON
  CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
target_compile_definitions(palpate_c_objects PRIVATE PALPATE_C_BUILD)
target_compile_options(palpate_c_objects PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
target_link_libraries(palpate_c_objects PRIVATE palpate_compiled)
set_target_properties(palpate_compiled PROPERTIES POSITION_INDEPENDENT_CODE ON)

# The objects of palpate::compiled come first. The linker keeps the first copy of a template that both contain, and
# another copy may contract a * b + c to one rounding elsewhere: forces have the bits of C++ programs that link
# palpate::compiled.
add_library(palpate_c SHARED $<TARGET_OBJECTS:palpate_compiled> $<TARGET_OBJECTS:palpate_c_objects>)
add_library(palpate::c ALIAS palpate_c)
set_target_properties(palpate_c PROPERTIES EXPORT_NAME c LINKER_LANGUAGE CXX SOVERSION 1
  VERSION 1.${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_link_libraries(palpate_c PRIVATE Threads::Threads)
target_include_directories(palpate_c INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)

# Exported are the functions of palpate.h and nothing else, neither of palpate::compiled nor of the standard library.
if(UNIX AND NOT APPLE)
  set(map ${PROJECT_BINARY_DIR}/c_interface/exported.map)
  file(CONFIGURE OUTPUT ${map} CONTENT "{ global: palpate_*; local: *; };\n" @ONLY)
  target_link_options(palpate_c PRIVATE -Wl,--version-script=${map} -Wl,--no-undefined)
  set_target_properties(palpate_c PROPERTIES LINK_DEPENDS ${map})
elseif(APPLE)
  target_link_options(palpate_c PRIVATE "-Wl,-exported_symbol,_palpate_*")
endif()

if(TARGET palpate_dev_options)
  target_compile_options(palpate_c_objects PRIVATE $<TARGET_PROPERTY:palpate_dev_options,INTERFACE_COMPILE_OPTIONS>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(palpate_c_objects PRIVATE -Wno-array-bounds)  # see compiled.cmake
  endif()
endif()

# palpate::xml_meshes: the headers of include/palpate/io/xml, which need pugixml and zlib. Headers only, so it can be
# linked next to palpate::palpate and palpate::compiled. palpate.hpp includes none of them.
set_property(CACHE PALPATE_XML_MESHES PROPERTY STRINGS AUTO ON OFF)
if(NOT PALPATE_XML_MESHES)
  return()
endif()

find_package(pugixml CONFIG QUIET)
find_package(ZLIB QUIET)
if(NOT pugixml_FOUND OR NOT ZLIB_FOUND)
  if(NOT PALPATE_XML_MESHES STREQUAL "AUTO")
    message(FATAL_ERROR "PALPATE_XML_MESHES needs pugixml and zlib.\n  Debian, Ubuntu: apt-get install libpugixml-dev zlib1g-dev\n"
                        "  macOS: brew install pugixml zlib\n  vcpkg: vcpkg install pugixml zlib")
  endif()
  return()
endif()

add_library(palpate_xml_meshes INTERFACE)
add_library(palpate::xml_meshes ALIAS palpate_xml_meshes)
set_target_properties(palpate_xml_meshes PROPERTIES EXPORT_NAME xml_meshes)
target_link_libraries(palpate_xml_meshes INTERFACE palpate pugixml::pugixml ZLIB::ZLIB)

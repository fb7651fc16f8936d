# Installs the headers and the package, so that find_package(palpate) works. They do not depend on the processor and
# need no build; palpate::compiled is installed, as a component, if it was built.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/palpate)

if(CMAKE_VERSION VERSION_GREATER_EQUAL 3.23)
  install(TARGETS palpate EXPORT palpateTargets FILE_SET HEADERS)
else()
  install(TARGETS palpate EXPORT palpateTargets)
  install(DIRECTORY include/palpate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.[hit]pp"
          PATTERN palpate/c EXCLUDE)
endif()
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${package_dir})

if(PALPATE_BUILD_COMPILED)
  install(TARGETS palpate_compiled EXPORT palpateCompiledTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)
  install(EXPORT palpateCompiledTargets NAMESPACE palpate:: DESTINATION ${package_dir})
  if(PALPATE_NATIVE AND PALPATE_HAS_MARCH_NATIVE)  # otherwise only the linker would say it
    install(CODE "message(STATUS \"palpate: this library is built with -march=native: so must be the programs that link it\")")
  endif()
endif()

if(TARGET palpate_xml_meshes)
  install(TARGETS palpate_xml_meshes EXPORT palpateXmlMeshesTargets)
  install(EXPORT palpateXmlMeshesTargets NAMESPACE palpate:: DESTINATION ${package_dir})
endif()

if(PALPATE_BUILD_C)
  install(TARGETS palpate_c EXPORT palpateCTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)
  install(EXPORT palpateCTargets NAMESPACE palpate:: DESTINATION ${package_dir})
  install(FILES include/palpate/c/palpate.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate/c)
endif()

configure_package_config_file(cmake/palpateConfig.cmake.in ${PROJECT_BINARY_DIR}/palpateConfig.cmake
                              INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/palpateConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/palpateConfig.cmake ${PROJECT_BINARY_DIR}/palpateConfigVersion.cmake
        DESTINATION ${package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/palpate)

# pkg-config: paths are relative to the .pc file, so that the installed folder may be moved. Absolute folders of the
# installation are taken as they are.
function(palpate_pc name folder)
  file(RELATIVE_PATH PALPATE_PC_TO_PREFIX ${CMAKE_INSTALL_FULL_${folder}}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  string(REGEX REPLACE "/$" "" PALPATE_PC_TO_PREFIX "${PALPATE_PC_TO_PREFIX}")
  foreach(used LIBDIR INCLUDEDIR)
    set(PALPATE_PC_${used} "\${prefix}/${CMAKE_INSTALL_${used}}")
    if(IS_ABSOLUTE "${CMAKE_INSTALL_${used}}")
      set(PALPATE_PC_${used} ${CMAKE_INSTALL_${used}})
    endif()
  endforeach()
  configure_file(cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_${folder}}/pkgconfig)
endfunction()
palpate_pc(palpate DATADIR)
if(PALPATE_BUILD_COMPILED)
  palpate_pc(palpate-compiled LIBDIR)
endif()
if(PALPATE_BUILD_C)
  palpate_pc(palpate-c LIBDIR)
endif()

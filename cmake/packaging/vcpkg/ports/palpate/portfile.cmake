# Builds the palpate that contains this port. A registry would fetch a release here with vcpkg_from_github.
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES
  compiled PALPATE_BUILD_COMPILED
  xml-meshes PALPATE_XML_MESHES)
if(NOT "compiled" IN_LIST FEATURES)
  set(VCPKG_BUILD_TYPE release)  # only headers
endif()

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${options} -DPALPATE_BUILD_TESTS=OFF -DPALPATE_BUILD_EXAMPLES=OFF -DPALPATE_BUILD_BENCHMARKS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/palpate)

# vcpkg wants .pc files with libraries (here -pthread) in lib.
foreach(folder IN ITEMS "${CURRENT_PACKAGES_DIR}" "${CURRENT_PACKAGES_DIR}/debug")
  if(EXISTS "${folder}/share/pkgconfig/palpate.pc")
    file(MAKE_DIRECTORY "${folder}/lib/pkgconfig")
    file(RENAME "${folder}/share/pkgconfig/palpate.pc" "${folder}/lib/pkgconfig/palpate.pc")
  endif()
endforeach()
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share"
                    "${CURRENT_PACKAGES_DIR}/share/licenses" "${CURRENT_PACKAGES_DIR}/share/pkgconfig")
file(INSTALL "${CURRENT_PORT_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/palpate")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")

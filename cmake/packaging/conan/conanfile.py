import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir


class Palpate(ConanFile):
    """Packages the palpate that contains this recipe: conan create cmake/packaging/conan"""
    name = "palpate"
    description = "Finite elements for haptics: the force between a tool and a mesh of soft tissue, every millisecond"
    license = "Apache-2.0"
    topics = ("haptics", "finite-elements", "simulation", "header-only")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    # header_only=False also builds palpate::compiled, which takes minutes.
    options = {"header_only": [True, False], "shared": [True, False], "fPIC": [True, False], "xml_meshes": [True, False]}
    default_options = {"header_only": True, "shared": False, "fPIC": True, "xml_meshes": False}
    implements = ["auto_shared_fpic", "auto_header_only"]

    @property
    def _palpate(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        header = load(self, os.path.join(self._palpate, "include", "palpate", "version.hpp"))
        self.version = ".".join(re.findall(r"#define PALPATE_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header))

    def export_sources(self):
        for name in "CMakeLists.txt", "LICENSE", "cmake/*.cmake", "cmake/*.in", "include/*":
            copy(self, name, self._palpate, self.export_sources_folder, excludes="cmake/packaging/*")

    def requirements(self):
        self.requires("eigen/[>=3.4.0 <6]", transitive_headers=True)
        if self.options.xml_meshes:
            self.requires("pugixml/[>=1.11 <2]", transitive_headers=True)
            self.requires("zlib/[>=1.2.11 <2]", transitive_headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["PALPATE_BUILD_COMPILED"] = not self.options.header_only
        toolchain.cache_variables["PALPATE_XML_MESHES"] = "ON" if self.options.xml_meshes else "OFF"
        for part in "TESTS", "EXAMPLES", "BENCHMARKS":
            toolchain.cache_variables[f"PALPATE_BUILD_{part}"] = False
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        if not self.options.header_only:
            cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "share", "licenses"))

    def package_info(self):
        # find_package uses palpate's own package, with its components.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("share", "cmake", "palpate")]
        self.cpp_info.set_property("pkg_config_name", "palpate")
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
        if not self.options.header_only:
            self.cpp_info.set_property("pkg_config_name", "palpate-compiled")
            self.cpp_info.libdirs = ["lib"]
            self.cpp_info.libs = ["palpate_compiled"]
            self.cpp_info.defines = ["PALPATE_COMPILED"]
        if self.settings.get_safe("os") in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs = ["pthread"]

"""Builds the module. It takes libpalpate_c from the folder PALPATE_C_LIBRARY, or else builds it with CMake (minutes).

The library is copied into the package, so that it needs nothing else. pybind11: Debian pybind11-dev, or pip.
"""
import os
import pathlib
import shutil
import subprocess

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

# Of palpate; PALPATE_SOURCE names it where this folder was copied.
SOURCE = pathlib.Path(os.environ.get("PALPATE_SOURCE") or pathlib.Path(__file__).resolve().parents[2])


def pybind11_include():
    try:
        import pybind11
        return [pybind11.get_include()]
    except ImportError:
        return []  # the folders that the compiler knows


class BuildWithLibrary(build_ext):
    def run(self):
        folder = os.environ.get("PALPATE_C_LIBRARY") or self.build_library()
        library = pathlib.Path(folder, "libpalpate_c.so.1")
        if not library.exists():
            raise RuntimeError(f"there is no {library}: build the target palpate_c with -DPALPATE_BUILD_C=ON")
        for extension in self.extensions:
            extension.extra_objects = [str(library)]
        super().run()
        for extension in self.extensions:
            target = pathlib.Path(self.get_ext_fullpath(extension.name)).parent
            shutil.copyfile(library, target / library.name)

    def build_library(self):
        folder = pathlib.Path(self.build_temp, "library").resolve()
        subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DPALPATE_BUILD_C=ON",
                        "-DPALPATE_BUILD_TESTS=OFF", "-DPALPATE_BUILD_EXAMPLES=OFF", "-DPALPATE_BUILD_BENCHMARKS=OFF"],
                       check=True)
        # Without a number, make would start all compilers at once: a gigabyte each.
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(os.cpu_count() or 1)
        subprocess.run(["cmake", "--build", folder, "--target", "palpate_c", "--parallel", jobs], check=True)
        return folder


setup(
    ext_modules=[Extension(
        "palpate._palpate", ["src/palpate/_palpate.cpp"], language="c++",
        include_dirs=[str(SOURCE / "include"), *pybind11_include()],
        extra_compile_args=["-std=c++17", "-O2", "-fvisibility=hidden"],
        extra_link_args=["-Wl,-rpath,$ORIGIN"])],
    cmdclass={"build_ext": BuildWithLibrary},
)

#!/bin/sh
# check.sh <root of palpate> <build folder> <jobs>: builds the packages of Debian, checks them with lintian, and compiles
# programs with what they contain. Where conan and vcpkg are installed, the same with their packages. `sh cmake/run
# packages` calls this.
set -eu
root=$1
build=$2
jobs=$3
version=$(sed -n 's/^palpate (\([^-]*\)-.*/\1/p' "$root/cmake/packaging/debian/changelog")
say() { echo "palpate: $*"; }

# consumer <folder> <further arguments>: tests/consumer, found by find_package.
consumer() {
  folder=$1
  shift
  cmake -S "$root/tests/consumer" -B "$folder" -DCMAKE_BUILD_TYPE= "$@" > "$folder.log" || { cat "$folder.log"; return 1; }
  cmake --build "$folder" > "$folder.log" || { cat "$folder.log"; return 1; }
  "$folder/stranger"
}

debian() {
  say "Debian packages, in $build/debian"
  rm -rf "$build/debian"
  source=$build/debian/palpate-$version
  mkdir -p "$source"
  (cd "$root" && tar -cf - --exclude=build CMakeLists.txt LICENSE README.md cmake docs examples include) | tar -xf - -C "$source"
  tar -czf "$build/debian/palpate_$version.orig.tar.gz" -C "$build/debian" "palpate-$version"
  cp -R "$root/cmake/packaging/debian" "$source/"
  (cd "$source" && dpkg-buildpackage -d -us -uc "-j$jobs" > ../build.log 2>&1) || { tail -n 50 "$build/debian/build.log"; return 1; }
  lintian --profile debian --display-info --fail-on error,warning,info "$build"/debian/*.changes > "$build/debian/lintian.txt" 2> /dev/null ||
    { cat "$build/debian/lintian.txt"; return 1; }
  say "lintian found nothing"

  packages=$build/debian/root
  for file in "$build"/debian/libpalpate-*.deb; do
    case $file in *-dbgsym_*) ;; *) dpkg-deb -x "$file" "$packages" ;; esac
  done
  say "C++ with find_package"
  consumer "$build/debian/consumer" -DCMAKE_PREFIX_PATH="$packages/usr"
  grep -q "^palpate_DIR:PATH=$packages/" "$build/debian/consumer/CMakeCache.txt" || { say "it found another palpate"; return 1; }

  pkgconfig=$packages/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/pkgconfig
  export PKG_CONFIG_PATH="$packages/usr/share/pkgconfig:$pkgconfig"
  say "C++ with pkg-config $(pkg-config --modversion palpate)"
  # shellcheck disable=SC2046 # flags
  "${CXX:-c++}" -std=c++20 "$root"/tests/consumer/*.cpp $(pkg-config --cflags --libs palpate) -o "$build/debian/by_pkg_config"
  "$build/debian/by_pkg_config"
  say "C with pkg-config $(pkg-config --modversion palpate-c)"
  # shellcheck disable=SC2046
  "${CC:-cc}" -std=c99 "$root/tests/c/press.c" $(pkg-config --cflags --libs palpate-c) -lm -o "$build/debian/press"
  LD_LIBRARY_PATH=$(dirname "$pkgconfig") "$build/debian/press" "$root/examples/data/organ.msh"
}

# With the Eigen that is installed, so that nothing is fetched, and a cache of its own.
conan_packages() {
  command -v conan > /dev/null || { say "Conan is left out: it is not installed (pip install conan)"; return 0; }
  say "Conan, in $build/conan"
  rm -rf "$build/conan"
  mkdir -p "$build/conan"
  export CONAN_HOME="$build/conan/home"
  conan profile detect > /dev/null 2>&1
  {
    echo "include(default)"
    echo "[settings]"
    echo "compiler.cppstd=20"
    echo "[platform_requires]"
    echo "eigen/$(pkg-config --modversion eigen3)"
    echo "[conf]"
    echo "tools.build:jobs=$jobs"
    echo "tools.cmake.cmake_layout:test_folder=$build/conan/test"
  } > "$build/conan/profile"
  for header_only in True False; do
    conan create "$root/cmake/packaging/conan" -pr:a "$build/conan/profile" -o "&:header_only=$header_only" --no-remote \
      > "$build/conan/$header_only.log" 2>&1 || { tail -n 50 "$build/conan/$header_only.log"; return 1; }
    say "header_only=$header_only: $(grep . "$build/conan/$header_only.log" | tail -n 1)"
  done
}

# vcpkg fetches Eigen, unless VCPKG_OVERLAY_PORTS has ports for it.
vcpkg_packages() {
  vcpkg=${VCPKG_ROOT:-/nowhere}/vcpkg
  [ -x "$vcpkg" ] || { say "vcpkg is left out: VCPKG_ROOT does not name its folder"; return 0; }
  say "vcpkg, in $build/vcpkg"
  rm -rf "$build/vcpkg"
  mkdir -p "$build/vcpkg"
  "$vcpkg" install palpate "--overlay-ports=$root/cmake/packaging/vcpkg/ports" "--x-install-root=$build/vcpkg/installed" \
    --binarysource=clear > "$build/vcpkg/install.log" 2>&1 || { tail -n 50 "$build/vcpkg/install.log"; return 1; }
  ! grep 'post-build check problem' "$build/vcpkg/install.log" || return 1
  consumer "$build/vcpkg/consumer" "-DCMAKE_TOOLCHAIN_FILE=$VCPKG_ROOT/scripts/buildsystems/vcpkg.cmake" \
    "-DVCPKG_INSTALLED_DIR=$build/vcpkg/installed" -DVCPKG_MANIFEST_MODE=OFF
}

mkdir -p "$build"
debian
conan_packages
vcpkg_packages

#!/bin/sh
# Coverage of the force gate by test_gate: lines, branches, and MC/DC where clang is 18 or newer.
#   sh tests/gate/coverage.sh [folder to build in]     CLANG chooses the compiler, EIGEN the folder of Eigen
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-$root/build/coverage}
eigen=${EIGEN:-/usr/include/eigen3}
clang=${CLANG:-}
for c in clang++-22 clang++-21 clang++-20 clang++-19 clang++-18 clang++ clang++-16 clang++-15 clang++-14; do
  if [ -z "$clang" ] && command -v "$c" >/dev/null 2>&1; then clang=$c; fi
done
[ -n "$clang" ] || { echo "no clang found"; exit 1; }
version=$("$clang" -dumpversion | cut -d. -f1)
suffix=-$version
command -v "llvm-cov$suffix" >/dev/null 2>&1 || suffix=
mcdc= show=
if [ "$version" -ge 18 ]; then mcdc=-fcoverage-mcdc show=--show-mcdc-summary; fi

mkdir -p "$out"
"$clang" -std=c++20 -O0 -fprofile-instr-generate -fcoverage-mapping $mcdc "-I$root/include" -isystem "$eigen" \
  "$root/tests/gate/main.cpp" -o "$out/test_gate"
LLVM_PROFILE_FILE="$out/gate.profraw" "$out/test_gate" --long 200000
"llvm-profdata$suffix" merge "$out/gate.profraw" -o "$out/gate.profdata"
set -- "$root/include/palpate/haptic/force_gate.hpp" "$root/include/palpate/core/limit_length.hpp"
for definitions in "$root/include/palpate/haptic/force_gate.ipp" "$root/include/palpate/core/limit_length.ipp"; do
  if [ -e "$definitions" ]; then set -- "$@" "$definitions"; fi
done
"llvm-cov$suffix" report "$out/test_gate" "-instr-profile=$out/gate.profdata" --show-branch-summary $show "$@"
[ -z "$mcdc" ] || show="--show-mcdc"
"llvm-cov$suffix" show "$out/test_gate" "-instr-profile=$out/gate.profdata" --show-branches=count $show "$@" >"$out/gate.txt"
echo "line by line: $out/gate.txt"

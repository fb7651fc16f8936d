#!/bin/sh
# Coverage of the whole library by all tests: lines and branches, per file and in total. Takes about half an hour.
#   sh tests/coverage.sh [folder to build in]     CLANG chooses the compiler
# A template counts once: a line is covered when any instantiation has run it.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/build/coverage-library}
clang=${CLANG:-clang++}
version=$("$clang" -dumpversion | cut -d. -f1)
suffix=-$version
command -v "llvm-cov$suffix" >/dev/null 2>&1 || suffix=

cmake -S "$root" -B "$out" -DCMAKE_BUILD_TYPE=None "-DCMAKE_CXX_COMPILER=$clang" \
  "-DCMAKE_CXX_FLAGS=-O1 -fprofile-instr-generate -fcoverage-mapping" -DPALPATE_TEST_UNITY=ON -DPALPATE_TEST_HEADERS=OFF \
  -DPALPATE_TEST_LINKING=OFF -DPALPATE_TEST_FLAGS=OFF -DPALPATE_BUILD_EXAMPLES=OFF -DPALPATE_BUILD_BENCHMARKS=OFF
cmake --build "$out" -j "$(getconf _NPROCESSORS_ONLN)"
rm -rf "$out/profiles"
failed=0
(cd "$out" && LLVM_PROFILE_FILE="$out/profiles/%2m.profraw" ctest -j "$(getconf _NPROCESSORS_ONLN)" --output-on-failure) || failed=1
"llvm-profdata$suffix" merge -sparse "$out"/profiles/*.profraw -o "$out/all.profdata"

set --
for program in "$out"/tests/test_*; do
  if [ -f "$program" ] && [ -x "$program" ]; then set -- "$@" -object "$program"; fi
done
shift  # the first program has no -object before it
"llvm-cov$suffix" report "$@" "-instr-profile=$out/all.profdata" --show-branch-summary --show-region-summary=false \
  "-ignore-filename-regex=^$root/tests|^/usr|palpate/testing/" >"$out/library.txt"
cat "$out/library.txt"
[ "$failed" -eq 0 ] || echo "some tests failed"
# file, functions, missed, executed, lines, missed, cover, branches, missed, cover
awk '$1 == "TOTAL" { print "the library: " $7 " of " $5 " lines, " $10 " of " $8 " branches" }' "$out/library.txt"
exit $failed

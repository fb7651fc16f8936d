#!/bin/sh
# Runs the tests that matter for safety under sanitizers: address and undefined behaviour, threads, real time. Reports
# the checks that are left out because the compiler lacks the sanitizer.
#   sh tests/sanitize.sh [folder to build in] [check ...]     CXX chooses the compiler, EIGEN the folder of Eigen
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/build/sanitize}
[ $# -eq 0 ] || shift
only=$*
cxx=${CXX:-g++}
mkdir -p "$out"
flags="-std=c++20 -O1 -g1 -I$root/include -I$root/tests -isystem ${EIGEN:-/usr/include/eigen3}"
failed=0

# check <name> <flags> <program's arguments> <sources...>
check() {
  name=$1 own=$2 args=$3
  shift 3
  case " ${only:-$name} " in *" $name "*) ;; *) return 0 ;; esac
  objects=
  case $1 in gate/* | realtime/*) ;; *) objects=$main ;; esac
  for source in "$@"; do
    object=$out/$(echo "$name-$source" | tr / _).o
    "$cxx" $flags $own -c "$root/tests/$source" -o "$object"
    objects="$objects $object"
  done
  "$cxx" $own $objects -o "$out/$name" -pthread
  if "$out/$name" $args >"$out/$name.log" 2>&1; then echo "clean: $name: $(tail -n 2 "$out/$name.log" | tr '\n' ' ')"
  else failed=1; echo "NOT CLEAN: $name, see $out/$name.log"; fi
}

# Catch2's own code is compiled without sanitizers: saves minutes.
main=${CATCH_MAIN:-$out/main.o}
[ -e "$main" ] || "$cxx" -std=c++20 -O0 -c "$root/tests/main.cpp" -o "$main"

undefined="-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
check address-gate "$undefined" "--long 300000" gate/main.cpp
check address-contact "$undefined" "" contact/friction_test.cpp contact/capsule_test.cpp contact/sweep_test.cpp \
  contact/contact_problem_test.cpp
check address-devices "$undefined" "" device/chai3d_test.cpp device/force_dimension_test.cpp device/openhaptics_test.cpp
check address-faults "$undefined" "" haptic/faults_test.cpp
check address-cut "$undefined" "" cut/cut_system_test.cpp cut/cuttable_tissue_test.cpp
for part in static moving cut; do
  check address-compositions-$part "$undefined" "" extremes/compositions_${part}_test.cpp
  check threads-compositions-$part "-fsanitize=thread" "" extremes/compositions_${part}_test.cpp
done
check threads-cut "-fsanitize=thread" "" cut/cuttable_tissue_test.cpp
check threads "-fsanitize=thread" "" core/triple_buffer_test.cpp core/spsc_ring_test.cpp haptic/lifetimes_test.cpp haptic/faults_test.cpp

cxx=
for c in clang++-22 clang++-21 clang++-20; do
  if [ -z "$cxx" ] && command -v "$c" >/dev/null 2>&1; then cxx=$c; fi
done
if [ -n "$cxx" ]; then
  check realtime "-fsanitize=realtime" "" realtime/main.cpp
  if [ ! -x "$out/realtime" ]; then :
  elif "$out/realtime" --allocate >"$out/realtime-caught.log" 2>&1; then failed=1; echo "NOT CAUGHT: a tick that allocates"
  else echo "caught: a tick that allocates"; fi
else
  echo "left out: RealtimeSanitizer, no clang 20 or newer"
fi
exit $failed

#!/bin/sh
# Cost of each policy in a small program: time to compile [s], size of the program [bytes], instructions per tick.
#   sh measure.sh <source folder> <folder for programs and tiny.csv>
# Needs g++ or $CXX and Eigen. Instructions are counted by perf, else by valgrind, else left out. $EIGEN_INCLUDE: folder
# of Eigen.
set -eu
source=$1
out=$2
cxx=${CXX:-g++}
eigen=${EIGEN_INCLUDE:-/usr/include/eigen3}
mkdir -p "$out"

instructions() {  # <program> <ticks>
  case $counter in
    perf) LC_ALL=C perf stat -x, -e instructions:u "$1" "$2" 2>&1 >/dev/null | awk -F, '/instructions/ { print $1 }' ;;
    valgrind)
      valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null "$1" "$2" 2>&1 >/dev/null |
        awk '/I *refs/ { gsub(/,/, ""); print $NF }' ;;
  esac
}

cat > "$out/nothing.c" <<'END'
int main(void) { return 0; }
END
${CC:-cc} "$out/nothing.c" -o "$out/nothing"
counter=none
if valgrind --version >/dev/null 2>&1; then counter=valgrind; fi
if perf stat -x, -e instructions:u "$out/nothing" 2>&1 | grep -q '^[0-9][0-9]*,.*instructions'; then counter=perf; fi
echo "instructions are counted by: $counter"

measure() {  # <name> <macros ...>: a line of tiny.csv
  name=$1
  shift
  program=$out/$(echo "$name" | tr -c 'A-Za-z0-9\n' _)
  # `times` in a subshell: its second line is the time of its child processes
  seconds=$(
    "$cxx" -std=c++20 -O2 -DNDEBUG "-I$source/include" -isystem "$eigen" "$@" \
      "$source/benchmarks/required/tiny/program.cpp" -o "$program" -pthread 2> "$program.messages" || exit 1
    times > "$program.times"
    awk -F '[ms ]' 'NR == 2 { print 60 * $1 + $2 }' "$program.times"
  ) || {
    cat "$program.messages" >&2
    echo "\"$name\",,,,,does not compile"
    return 0
  }
  strip "$program"
  bytes=$(wc -c < "$program" | tr -d ' ')
  answer=$("$program" 1200) || answer="WRONG: $answer"
  per_tick=
  if [ "$counter" != none ] && [ -n "$answer" ]; then
    per_tick=$(( ($(instructions "$program" 1200) - $(instructions "$program" 200)) / 1000 ))
  fi
  echo "\"$name\",$seconds,$bytes,$per_tick,$counter,\"$answer\""
}

# One job per processor at a time, as processor time is measured. The order of the lines is kept.
jobs=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
rows=0
rm -f "$out"/row_*
row() {
  while [ $((rows - $(find "$out" -name 'row_*.done' | wc -l))) -ge "$jobs" ]; do sleep 1; done
  rows=$((rows + 1))
  line=$out/row_$rows
  { measure "$@" > "$line.txt"; : > "$line.done"; } &
}

row "a mesh only"
row "a mesh only, umbrella header" -DTINY_UMBRELLA
row "Tet4, Condensed<SelectiveInverse>" -DTINY_ELEMENT=Tet4 "-DTINY_SOLVER=Condensed<SelectiveInverse>"
row "Tet4, Condensed<SelectiveInverseFloat>" -DTINY_ELEMENT=Tet4 "-DTINY_SOLVER=Condensed<SelectiveInverseFloat>"
row "Smoothed<Tet4>, Condensed<SelectiveInverse>" '-DTINY_ELEMENT_HEADER=<palpate/element/wrappers.hpp>' \
  "-DTINY_ELEMENT=Smoothed<Tet4>" "-DTINY_SOLVER=Condensed<SelectiveInverse>"
row "Tet10, Condensed<SelectiveInverse>" '-DTINY_ELEMENT_HEADER=<palpate/element/tet10.hpp>' -DTINY_ELEMENT=Tet10 \
  -DTINY_PROMOTE "-DTINY_SOLVER=Condensed<SelectiveInverse>"
row "Tet4, SparseCholesky" -DTINY_ELEMENT=Tet4 -DTINY_SOLVER=SparseCholesky
row "Tet4, ConjugateGradient" -DTINY_ELEMENT=Tet4 -DTINY_SOLVER=ConjugateGradient
row "Tet4, neo-Hookean, Implicit<Newton>" -DTINY_SOFT
wait

echo "program,compile_s,bytes,instructions_per_tick,counter,answer" > "$out/tiny.csv"
for i in $(seq "$rows"); do cat "$out/row_$i.txt"; done | tee -a "$out/tiny.csv"

{
  echo "| program | compile [s] | size [kB] | instructions per tick |"
  echo "|---|---|---|---|"
  sed -e 1d -e 's/, / \& /g' "$out/tiny.csv" | awk -F, '{ gsub(/"/, ""); name = $1; gsub(/ & /, ", ", name)
    printf "| `%s` | %s | %.0f | %s |\n", name, $2, $3 / 1000, $4 }'
} > "$out/tiny.md"
! grep -q "does not compile\|WRONG" "$out/tiny.csv"

#!/bin/sh
# What goes wrong in the life of the window `live`: the program never crashes, says what it refuses, and ends with zero
# force on all devices (its exit code). Needs xvfb-run and xdotool (apt-get install xvfb xauth xdotool).
#   sh tests/live/trouble.sh <the program live>            half a minute per scene
#   sh tests/live/trouble.sh <the program live> --minute   also sixty seconds of scripted input per scene, with and
#                                                          without drawing: frames per second, missed deadlines
set -u
live=$(realpath "$1")
minute=${2:-}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 2
failed=0

screen() { xvfb-run -a -s "-screen 0 1280x800x24" "$@"; }

# report <name> <exit code> <expected text>: the output of the program is in output.txt.
report() {
  if [ "$2" -eq 0 ] && grep -q "$3" output.txt; then
    printf '%-52s ok, force zero; %s\n' "$1" "$(grep -o 'peak force [^,]*' output.txt | tail -n 1)"
  else
    printf '%-52s FAILED, exit code %s\n' "$1" "$2"
    tail -n 5 output.txt
    failed=1
  fi
}

for scene in palpate retract grasp cut beating; do
  screen "$live" --scene $scene --script scene --seconds 12 --trouble --no-error-bars > output.txt 2>&1
  report "$scene: resized, minimised, unplugged, switched" $? 'peak force'
done

# Input as of a hand: the pointer moves in coarse steps, presses, pushes with the wheel, drags.
hand() {
  cat > hand.sh <<'END'
timeout 90 "$@" > output.txt 2>&1 &
window=$!
timeout 30 xdotool search --sync --onlyvisible --name palpate > /dev/null
sleep 6  # the set-up
xdotool mousemove 400 420
sleep 0.3
xdotool mousedown 1
for k in 1 2 3 4 5 6; do xdotool click 4; sleep 0.05; done
for x in 430 470 430 390 420; do xdotool mousemove $x 430; sleep 0.2; done
. ./ending.sh
wait $window
echo $? > code
END
  screen sh hand.sh "$live" "$@"
  code=$(cat code)
}
echo 'xdotool key Escape' > ending.sh
hand --no-error-bars
report "palpate: closed with Escape while it presses" "$code" 'peak force 0.[0-9]*[1-9]'
echo 'xdotool key u; sleep 0.5; xdotool key Escape' > ending.sh
hand --no-error-bars
report "palpate: unplugged while it presses, then closed" "$code" 'peak force 0.[0-9]*[1-9]'

printf '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\nnonsense\n' > broken.msh
screen "$live" broken.msh --seconds 3 --no-error-bars --screenshot refused.png > output.txt 2>&1
report "a mesh that is refused: the message is in the window" $? '^refused: '
screen "$live" --device replay nothing.csv --seconds 2 > output.txt 2>&1
code=$?
if [ $code -eq 2 ] && grep -q nothing.csv output.txt; then echo "a recording that does not exist: refused, exit code 2"; else
  echo "a recording that does not exist: FAILED, exit code $code"
  failed=1
fi
screen "$live" --script scene --seconds 8 --record hand.csv --no-error-bars > output.txt 2>&1
head -n 900 hand.csv > lost.csv  # the device is lost in the middle of a press
screen "$live" --device replay lost.csv --seconds 10 --no-error-bars > output.txt 2>&1
report "a device is lost while it presses" $? 'Disconnected'

if [ "$minute" = --minute ]; then
  for scene in palpate retract grasp cut beating; do
    for drawing in '' --no-drawing; do
      screen "$live" --scene $scene --script scene --seconds 60 $drawing > output.txt 2>&1
      frames=$(awk '/frames in/ { printf "%.0f", $1 / $4 }' output.txt)
      printf '%-10s %-13s %3s frames/s, %s; %s\n' $scene "${drawing:-drawing}" "$frames" \
        "$(grep -o 'longest frame [0-9.]* ms' output.txt)" "$(grep -o 'missed deadlines [0-9]*' output.txt)"
    done
  done
fi
exit $failed

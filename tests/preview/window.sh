#!/bin/bash
# The window under Xvfb, by real keys, clicks, drags and a dropped file: the pictures that `s`
# saves, each as the first one or different from it, as is said for it.
#   window.sh PROGRAM SCENE DROP, under xvfb-run; DROP: the program of drop.c
set -euo pipefail
program=$1 scene=$2 drop=$3
folder=$(mktemp -d)
trap 'kill "$pid" 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
cp -r "$(dirname "$scene")/.." data
scene=data/scenes/$(basename "$scene")

fail() {
    echo "$*" >&2
    exit 1
}

"$program" --size 320x240 --samples 1 --model sppg --rays 20000 "$scene" 2>errors &
pid=$!
n=0

# Save a picture, wait for it: `first`, `same` as the first, or `other`.
saved() {
    n=$((n + 1))
    xdotool key s
    for _ in {1..600}; do
        kill -0 "$pid" || fail "the window closed: $(cat errors)"
        [[ -s ppscat-preview-$n.png ]] && break
        sleep 0.05
    done
    sleep 0.1
    case $1 in
    first) ;;
    same) cmp -s ppscat-preview-{1,$n}.png || fail "$2: not as at first" ;;
    other) ! cmp -s ppscat-preview-{1,$n}.png || fail "$2: as at first" ;;
    esac
}

# keys EXPECTED KEY...
keys() {
    xdotool key --delay 50 "${@:2}"
    saved "$1" "after ${*:2}"
}

# there_and_back "KEY..." "KEY...": another picture, and the first again
there_and_back() {
    # shellcheck disable=SC2086
    keys other $1
    # shellcheck disable=SC2086
    keys same $2
}

# Rows of the panel, as tests/preview/test_window_events.c has them drawn: letters of
# 6 x 11 dots from (12, 12) on.
at_row() { xdotool mousemove --window "$window" "$2" $((12 + 11 * $1 + 5)); }

for _ in {1..600}; do
    window=$(xdotool search --onlyvisible --name ppscat-preview 2>/dev/null | head -1) || true
    [[ $window ]] && break
    sleep 0.05
done
[[ $window ]] || fail "no window: $(cat errors)"
sleep 0.5
xdotool windowfocus --sync "$window"
saved first
there_and_back "Left Left Left" "Right Right Right"
there_and_back bracketright bracketleft
there_and_back "f" "f f"
there_and_back "c c" "c c c h h"
there_and_back "m" "shift+m"
there_and_back "shift+x" "x"
there_and_back "2 2" "0"
there_and_back "t t" "shift+t shift+t"
there_and_back "g" "g g"
there_and_back "p" "p"
there_and_back "d d d d d" "shift+d shift+d shift+d shift+d shift+d"
there_and_back "n" "shift+n"
keys same Tab
keys same Tab

keys other shift+x # the split's line, by key and by mouse
cp ppscat-preview-$n.png split.png
keys other period
cmp -s split.png ppscat-preview-$n.png && fail "the split's line did not move"
xdotool key comma mousemove --window "$window" 160 220 mousedown 1 \
    mousemove --window "$window" 230 220 mouseup 1
saved other "a split whose line is dragged"
cmp -s split.png ppscat-preview-$n.png && fail "the split's line was not dragged"
keys same x

at_row 12 270 && xdotool click 1 # exposure, more; less; by wheel
saved other "a click on >"
at_row 12 171 && xdotool click 1
saved same "a click on <"
at_row 12 270 && xdotool click 4
saved other "the wheel on a row"
xdotool click 5
saved same "the wheel back"

xdotool mousemove --window "$window" 300 210 click 4
saved other "the wheel"
keys same Home
xdotool mousemove --window "$window" 300 210 mousedown 1 \
    mousemove --window "$window" 250 215 mouseup 1
saved other "the view turned"
keys same Home
xdotool windowsize --sync "$window" 300 200
saved other "a smaller window"
xdotool windowsize --sync "$window" 320 240
saved same "the size as at first"
xdotool mousemove --window "$window" 300 210 mousedown 3 \
    mousemove --window "$window" 280 210 mouseup 3
saved other "the sun dragged"
xdotool keydown shift mousemove --window "$window" 300 210 mousedown 3 \
    mousemove --window "$window" 290 210 mouseup 3 keyup shift
saved other "the time dragged"

sed -i 's/"unit": 0.2/"unit": 0.1/' "$scene"
sleep 2
saved other "the scene changed"
cp ppscat-preview-$n.png changed.png
cp data/trees/oak_small.obj "data/trees/an oak.obj"
"$drop" "$window" "$folder/data/trees/an oak.obj" || fail "the drop was not taken"
saved other "a file dropped"
cmp -s changed.png ppscat-preview-$n.png && fail "the dropped file is not shown"
xdotool key q
wait "$pid" || fail "exit $?: $(cat errors)"
[[ ! -s errors ]] || fail "$(cat errors)"

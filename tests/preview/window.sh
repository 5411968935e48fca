#!/bin/bash
# The window under Xvfb: keys, a drag and a changed scene, by the pictures that `s` saves.
#   window.sh PROGRAM SCENE, under xvfb-run, in a folder of its own
set -euo pipefail
program=$1 scene=$2
folder=$(mktemp -d)
trap 'kill "$pid" 2>/dev/null || true; rm -rf "$folder"' EXIT
cd "$folder"
cp -r "$(dirname "$scene")/.." data
scene=data/scenes/$(basename "$scene")

fail() {
    echo "$*" >&2
    exit 1
}

"$program" --size 320x240 --samples 1 --model ss "$scene" 2>errors &
pid=$!
n=0

# press KEY...: then save a picture, and wait for it
picture() {
    n=$((n + 1))
    (($# == 0)) || xdotool key --delay 100 "$@"
    xdotool key s
    for _ in {1..300}; do
        kill -0 "$pid" || fail "the window closed: $(cat errors)"
        [[ -s ppscat-preview-$n.png ]] && sleep 0.3 && return
        sleep 0.1
    done
    fail "no picture $n after: $*"
}

for _ in {1..300}; do
    window=$(xdotool search --onlyvisible --name ppscat-preview 2>/dev/null | head -1) || true
    [[ $window ]] && break
    sleep 0.1
done
[[ $window ]] || fail "no window: $(cat errors)"
sleep 0.5
xdotool windowfocus --sync "$window"
picture
picture Left Left Left            # the sun moves
picture bracketright              # exposure
picture bracketleft Right Right Right # as at first
picture f                         # false colour
picture f f c c                   # a component, indirect
picture c c c h h                 # as at first
xdotool mousemove 150 150 mousedown 1 mousemove 200 140 mouseup 1
picture                           # the view turned
picture Home                      # as at first
xdotool windowsize --sync "$window" 240 200
picture                           # smaller
xdotool windowsize --sync "$window" 320 240
picture m                         # the next model, leaf
picture shift+m                   # as at first
sed -i 's/"unit": 0.2/"unit": 0.1/' "$scene"
sleep 2
picture                           # the scene changed
xdotool key q
wait "$pid" || fail "exit $?: $(cat errors)"

for same in 4 7 9 12; do
    cmp -s ppscat-preview-1.png ppscat-preview-$same.png || fail "picture $same is not as 1"
done
for other in 2 3 5 6 8 10 11 13; do
    ! cmp -s ppscat-preview-1.png ppscat-preview-$other.png || fail "picture $other is as 1"
done
[[ ! -s errors ]] || fail "$(cat errors)"

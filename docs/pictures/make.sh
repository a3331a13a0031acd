#!/bin/sh
# Makes the pictures, the film and the screenshots of README.md and docs/.
#
# usage: docs/pictures/make.sh [FOLDER OF THE PROGRAMS [FOLDER OF THE RESULTS]]
#
# It needs ffmpeg, and for the screenshots Chromium and the packages of tests/web (the build's target
# web_tests); what can't be made for want of these is named and left as it is. LONG=no and SCREENSHOTS=no leave out
# what takes minutes, and the screenshots.
set -eu
cd "$(dirname "$0")/../.."
programs=$(cd "${1:-build/release/bin}" && pwd)
results=${2:-docs/pictures}
ziggurat=$programs/ziggurat

picture() {  # NAME SCENE OPTION...
  name=$1 scene=$2
  shift 2
  "$ziggurat" render "scenes/$scene.argos" --size 720x440 --quiet --out "$results/$name.png" "$@"
}

film() {  # NAME SCENE OPTION...
  name=$1 scene=$2
  shift 2
  "$ziggurat" render "scenes/$scene.argos" --size 480x300 --quiet --video "$results/$name" "$@"
}

picture drop dynamics3d_single_body_test --at 0.1 --eye 0.52,-0.69,0.56 --look-at 0,-0.04,0.04 --fov 48
picture vehicle dynamics3d_multi_body_test --at 3 --eye 0.3,-0.46,0.28 --look-at -0.02,-0.01,0.01 --fov 46
picture layers footbot_camera_prototype_example --at 2 --layers rays,frusta,labels

is_long() { [ "${LONG:-yes}" = yes ]; }

# Of one run each: the stacking robot, the staircase, and the pyramid, which takes half a minute on two cores.
pictures() {  # NAME SCENE TIMES OPTION...
  name=$1 scene=$2 times=$3
  shift 3
  "$ziggurat" render "scenes/$scene.argos" --size 640x400 --quiet --at "$times" --out "$results/$name" "$@"
}
pictures stacking_%d.png prototype_srocs_system 0,9,18,25,32 --eye 0.02,-0.85,0.42 --look-at 0.23,0,0.07
pictures staircase.png construction/staircase 410 --eye -0.35,-0.75,0.6 --look-at 0.12,0.05,0.03 --fov 60
if is_long; then
  pictures pyramid_%d.png construction/pyramid 0,90,180,300 --eye -0.35,-0.95,0.75 --look-at 0,0,0.03 --fov 60
fi

plot() {  # EXPERIMENT PARAMETER METRIC
  sweep=$(mktemp -d)
  "$ziggurat" sweep "scenes/experiments/$1.toml" --out "$sweep/out" --quiet
  "$ziggurat" sweep plot "$sweep/out" --x "$2" --y "$3" --file "$sweep/$1.svg"
  cp "$sweep/$1.svg" "$results"
  rm -r "$sweep"
}

if is_long; then  # on two cores one minute (docs/experiments.md) and some ten
  plot aggregation share swarm/time_to_aggregate
  plot pyramid robots site/time_to_finish
fi

if command -v ffmpeg > /dev/null; then
  film stacking.webp prototype_srocs_system --from 5 --to 33 --speed 4 --fps 12 \
    --eye 0.02,-0.85,0.42 --look-at 0.02,-0.05,0.05 --fov 40
  if is_long; then
    film pyramid.webp construction/pyramid --to 288 --speed 16 --fps 12 \
      --eye -0.45,-1.15,0.85 --look-at 0,0,0.03 --fov 58
  fi
else
  echo "make.sh: no film without ffmpeg (sudo apt install ffmpeg)" >&2
fi

if [ "${SCREENSHOTS:-yes}" = yes ]; then
  ZIGGURAT_BIN=$programs node docs/pictures/screenshots.mjs "$results" ||
    echo "make.sh: no screenshots (sudo apt install chromium; ninja -C build/release web web_tests)" >&2
fi

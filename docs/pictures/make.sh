#!/bin/sh
# Makes the pictures, the film and the screenshots of README.md and docs/.
#
# usage: docs/pictures/make.sh [FOLDER OF THE PROGRAMS [FOLDER OF THE RESULTS]]
#
# It needs ffmpeg, gnuplot, and for the screenshots Chromium and the packages of tests/web (the build's target
# web_tests); what can't be made for want of these is named and left as it is.
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

if command -v gnuplot > /dev/null; then  # one minute of wall time on two cores (docs/experiments.md)
  sweep=$(mktemp -d)
  "$ziggurat" sweep scenes/experiments/aggregation.toml --out "$sweep/out" --quiet
  "$ziggurat" sweep plot "$sweep/out" --x share --y swarm/time_to_aggregate --file "$sweep/aggregation.svg"
  cp "$sweep/aggregation.svg" "$results"
  rm -r "$sweep"
else
  echo "make.sh: no plot without gnuplot (sudo apt install gnuplot-nox)" >&2
fi

if command -v ffmpeg > /dev/null; then
  film stacking.webp prototype_srocs_system --from 5 --to 33 --speed 4 --fps 12 \
    --eye 0.02,-0.85,0.42 --look-at 0.02,-0.05,0.05 --fov 40
else
  echo "make.sh: no film without ffmpeg (sudo apt install ffmpeg)" >&2
fi

if [ "${SCREENSHOTS:-yes}" = yes ]; then
  ZIGGURAT_BIN=$programs node docs/pictures/screenshots.mjs "$results" ||
    echo "make.sh: no screenshots (sudo apt install chromium; ninja -C build/release web web_tests)" >&2
fi

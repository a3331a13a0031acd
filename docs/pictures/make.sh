#!/bin/sh
# Draws the pictures of README.md. Usage: docs/pictures/make.sh [FOLDER OF THE PROGRAMS]
set -eu
cd "$(dirname "$0")/../.."
ziggurat="${1:-build/release/bin}/ziggurat"

picture() {  # NAME SCENE OPTION...
  name=$1 scene=$2
  shift 2
  "$ziggurat" render "scenes/$scene.argos" --size 720x440 --quiet \
    --out "docs/pictures/$name.png" "$@"
}

picture drop dynamics3d_single_body_test --at 0.1 --eye 0.52,-0.69,0.56 --look-at 0,-0.04,0.04 --fov 48
picture vehicle dynamics3d_multi_body_test --at 3 --eye 0.3,-0.46,0.28 --look-at -0.02,-0.01,0.01 --fov 46

#!/bin/sh
# Makes the pictures, films and plots of the tutorial's pages.
#
# usage: docs/tutorial/make_pictures.sh [FOLDER OF THE PROGRAMS]
#
# Films need ffmpeg.
set -eu
cd "$(dirname "$0")"
PATH=$(cd "${1:-../../build/release/bin}" && pwd):/usr/bin:$PATH  # Debian's Python has what a controller needs
export PATH
temporary=$(mktemp -d)
trap 'rm -r "$temporary"' EXIT

picture() {  # STEP OPTION...
  step=$1
  shift
  ziggurat render "$step/scene.argos" --size 480x300 --quiet --out "$step/picture.png" "$@" > "$temporary/log"
}

film() {  # STEP OPTION...
  step=$1
  shift
  ziggurat render "$step/scene.argos" --size 400x250 --fps 12 --quiet --video "$step/film.webp" "$@" > "$temporary/log"
}

picture 01-box --at 0.3 --eye 1.4,-1.6,0.9 --look-at 0,0,0.35
film 02-wheel --to 1.5 --speed 0.5 --eye 0.9,-1.0,0.8 --look-at 0.05,0,0.3
film 03-four-wheels --speed 0.5 --eye 0.4,-2.6,1.3 --look-at 0,0,0.2
film 04-lua --to 5 --eye 0,-1.6,0.8 --look-at 0,0,0
picture 05-python --at 2 --eye 0.6,-0.7,0.4 --look-at 0.1,0,0
picture 06-camera --at 1 --layers frusta --eye -0.4,-0.9,0.7 --look-at 0.5,0.05,0
film 07-follow --from 5 --to 15 --speed 2 --eye 0.1,-2.1,1.5 --look-at -0.1,-0.5,0
film 08-radios --from 1.5 --to 5 --layers rays --eye -0.8,-1.4,1 --look-at 0.4,0,0

ziggurat run 07-follow/scene.argos --record "$temporary/run.mcap" --quiet
ziggurat fork "$temporary/run.mcap" --at 500 --script follow.lua=09-record/closer.lua --record "$temporary/closer.mcap" --quiet
ziggurat diff "$temporary/run.mcap" "$temporary/closer.mcap" --plot 09-record/apart.svg > "$temporary/log" || [ $? = 5 ]

ziggurat sweep 10-sweep/sweep.toml --out "$temporary/results" --quiet
ziggurat sweep plot "$temporary/results" --x steer --y follower/aside --file "$temporary/aside.svg"
cp "$temporary/aside.svg" 10-sweep

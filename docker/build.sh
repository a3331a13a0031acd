#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the images ziggurat-server, ziggurat-controller and ziggurat-dev, and tells their sizes.
#
# usage: docker/build.sh [--engine docker|podman|buildah] [--base IMAGE] [server|controller|dev]...
#
#   --engine   default: the first of them that is installed
#   --base     default: debian:bookworm-slim from its registry; with buildah `debootstrap` makes one instead, from
#              where apt of this machine has packages: it needs root, and no registry
#
# Packages are those of tools/packaging/debian/build, which runs first if there are none. For docker/compose.yaml it makes
# keys in docker/keys, unless they are there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
readonly packages=build/package/packages image_user=10001

engine=''
base=debian:bookworm-slim
images=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --engine) engine=${2:?--engine needs a name}; shift 2 ;;
    --base) base=${2:?--base needs an image}; shift 2 ;;
    -h | --help) sed -n '/^# SPDX/d; s/^# \{0,1\}//p' "$0" | sed 1d; exit ;;
    server | controller | dev) images+=("$1"); shift ;;
    *) echo "docker/build.sh: there is no '$1'; see docker/build.sh --help" >&2; exit 2 ;;
  esac
done
[[ ${#images[@]} -gt 0 ]] || images=(server controller dev)
for each in docker podman buildah; do
  [[ -n $engine ]] || ! command -v "$each" >/dev/null || engine=$each
done
[[ -n $engine ]] || { echo "docker/build.sh: docker, podman or buildah is needed: apt-get install buildah" >&2; exit 1; }
[[ $engine != buildah ]] || export BUILDAH_ISOLATION=${BUILDAH_ISOLATION:-chroot} STORAGE_DRIVER=${STORAGE_DRIVER:-vfs}

# A minimal Debian 12 as the image $1, as debian:bookworm-slim is: without documents, translations and lists.
make_base() {
  local folder container mirror
  folder=$(mktemp -d "${TMPDIR:-/var/tmp}/ziggurat-base.XXXXXX")
  # shellcheck disable=SC2016  # the format is apt's
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' | sed -n 's/ bookworm$//p' | head -n 1)
  debootstrap --variant=minbase --include=ca-certificates bookworm "$folder/root" ${mirror:+"$mirror"} >"$folder/log" ||
    { tail -n 20 "$folder/log" >&2; return 1; }
  rm -rf "$folder"/root/{usr/share/{doc,man,info,locale},var/cache/apt,var/lib/apt/lists,dev}/*
  rm -f "$folder"/root/var/cache/ldconfig/aux-cache "$folder"/root/var/log/*.log
  container=$(buildah from scratch)
  buildah add -q "$container" "$folder/root" / >/dev/null
  buildah commit -q "$container" "$1" >/dev/null
  buildah rm "$container" >/dev/null
  rm -rf --one-file-system "$folder"
}

build() {
  local options=(-f "docker/$1.Dockerfile" -t "ziggurat-$1")
  case $1 in
    server) options+=(--build-arg "BASE=$base") ;;
    controller) options+=(--build-arg "SERVER=$local_name/ziggurat-server") ;;
    dev) options+=(--build-arg "CONTROLLER=$local_name/ziggurat-controller") ;;
  esac
  if [[ $engine == buildah ]]; then
    # apt of the container has the sources of this machine. Health checks are of docker's format.
    buildah bud -q --format docker --pull-never --volume /etc/apt:/etc/apt:ro "${options[@]}" .
  else
    "$engine" build -q "${options[@]}" .
  fi
}

size_of() {
  "$engine" inspect ${2:+"$2"} --format '{{.Size}}' "ziggurat-$1" 2>/dev/null ||
    buildah images --json "ziggurat-$1" | sed -n 's/.*"size": "\(.*\)".*/\1/p'
}

make_keys() {
  [[ ! -e docker/keys/clients ]] || return 0
  local ziggurat=build/package/bin/ziggurat
  mkdir -p docker/keys
  "$ziggurat" keygen --out docker/keys/server >/dev/null
  "$ziggurat" keygen --out docker/keys/controller >/dev/null
  printf '%s controller the Lua controller\n' "$(cat docker/keys/controller.public)" >docker/keys/clients
  [[ $(id -u) -ne 0 ]] || chown -R "$image_user" docker/keys
}

compgen -G "$packages/ziggurat_*.deb" >/dev/null || tools/packaging/debian/build
local_name=localhost
if [[ $engine == docker ]]; then local_name=docker.io/library; fi
if [[ $engine == buildah && $base == debian:bookworm-slim ]]; then
  base=localhost/ziggurat-base
  buildah inspect "$base" >/dev/null 2>&1 || make_base "$base"
fi
for image in "${images[@]}"; do
  build "$image" >/dev/null
  printf 'ziggurat-%s: %s\n' "$image" "$(size_of "$image")"
done
make_keys

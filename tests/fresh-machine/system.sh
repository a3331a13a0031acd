# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Minimal Debian 12 systems for tests, to be sourced: make_system FOLDER [PACKAGE,…], mount_system FOLDER.

readonly SKIPPED=77  # exit code
export node_certificates=/etc/ssl/certs/of-node.pem  # in the system

skip() { printf 'skipped: %s\n' "$*"; exit "$SKIPPED"; }

# Ends the test where no system can be made.
check_can_make_systems() {
  [[ $(id -u) -eq 0 ]] || skip "making a system of its own takes root"
  command -v debootstrap >/dev/null || skip "debootstrap is not installed: apt-get install debootstrap"
  unshare --mount --pid --fork true 2>/dev/null || skip "this root may not make namespaces (unshare)"
}

# Where this machine's apt has bookworm from; empty: debootstrap's default.
mirror() {
  if [[ -n ${MIRROR:-} ]]; then printf '%s\n' "$MIRROR"; return; fi
  # shellcheck disable=SC2016  # the format is apt's, not the shell's
  apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' 2>/dev/null |
    sed -n 's/ bookworm$//p' | head -n 1
}

# A minimal system in the folder $1, with the packages $2, this machine's settings for apt and names, and what its node
# trusts. Systems with the same packages are kept for a week, in a file of TMPDIR.
make_system() {
  local packages=${2:-git,ca-certificates}
  local kept="${TMPDIR:-/var/tmp}/ziggurat-bookworm-${packages//,/-}.tar"
  mkdir -p "$1"
  if [[ -n $(find "$kept" -mtime -7 2>/dev/null) ]]; then
    tar -C "$1" -xf "$kept"
  else
    # shellcheck disable=SC2046  # no mirror, no word
    debootstrap --variant=minbase --include="$packages" bookworm "$1" $(mirror) >"$1.log" ||
      { tail -n 20 "$1.log" >&2; return 1; }
    rm "$1.log"
    tar -C "$1" -cf "$kept.new" . && mv "$kept.new" "$kept"
  fi
  local codename
  codename=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-}")
  if [[ $codename == bookworm && -z ${MIRROR:-} ]]; then
    cp -a /etc/apt/. "$1/etc/apt/"
    [[ ! -d /usr/share/keyrings ]] || cp -an /usr/share/keyrings/. "$1/usr/share/keyrings/"
  fi
  cp -L /etc/resolv.conf /etc/hosts "$1/etc/"
  [[ ! -f ${NODE_EXTRA_CA_CERTS:-} ]] || cp -L "$NODE_EXTRA_CA_CERTS" "$1$node_certificates"
}

# The device files that programs expect, in the folder $1/dev, and /proc.
mount_system() {
  local name
  mount -t proc proc "$1/proc"
  mount -t tmpfs -o mode=755 dev "$1/dev"
  for name in null zero full random urandom tty; do
    touch "$1/dev/$name"
    mount --bind "/dev/$name" "$1/dev/$name"
  done
  mkdir -m 1777 "$1/dev/shm"
  mkdir "$1/dev/pts"
  mount -t devpts -o newinstance,ptmxmode=0666,mode=620 devpts "$1/dev/pts"
  ln -s pts/ptmx "$1/dev/ptmx"
  ln -s /proc/self/fd "$1/dev/fd"
  ln -s fd/0 "$1/dev/stdin"
  ln -s fd/1 "$1/dev/stdout"
  ln -s fd/2 "$1/dev/stderr"
}
export -f mount_system

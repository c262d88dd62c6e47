#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tries the files of tools/scripts/release.sh where nothing else is installed: test_package.sh CASE
#   deb         in Debian 12: installs the package and renders a picture, says how long both take; then the module for TIFF
#   tarball     in Debian 12, without packages and without write access
#   ubuntu      the same in Ubuntu 24.04
#   dockerfile  the steps of Dockerfile, which compile everything
# As root, on a machine with Debian's mirror; other machines skip it (status 77). Roots by debootstrap are in
# build/package_roots, of which those of the distributions are kept. `ctest --preset package` makes a release
# and runs every case.
set -euo pipefail
cd "$(dirname "$0")/../.."
source tools/scripts/packages.sh
roots=$PWD/build/package_roots
model=share/chromeball/still-life.glb probe=share/chromeball/dusk.exr
small="--size 96x64 --samples 4 --quiet"

skip() { echo "Skipped: $*" >&2; exit 77; }

# A fresh copy of a distribution's least root, at $roots/NAME.
makeRoot() {  # NAME SUITE MIRROR [OPTION OF DEBOOTSTRAP...]
  local name=$1 suite=$2 mirror=$3 script=/usr/share/debootstrap/scripts/$2
  shift 3
  [[ -e $script ]] || script=/usr/share/debootstrap/scripts/gutsy  # that of all newer Ubuntu
  if [[ ! -e $roots/$suite ]]; then
    rm -rf "$roots/$suite.new"
    mkdir -p "$roots"
    debootstrap --variant=minbase "$@" "$suite" "$roots/$suite.new" "$mirror" "$script" >"$roots/$suite.log" ||
      { tail -n 20 "$roots/$suite.log" >&2; exit 1; }
    mv "$roots/$suite.new" "$roots/$suite"
  fi
  rm -rf "${roots:?}/$name"
  cp -a "$roots/$suite" "$roots/$name"
}
makeBookworm() {
  local mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' 'Component: main' \
    'Created-By: Packages' | head -n 1)
  makeRoot "$1" bookworm "${mirror:-http://deb.debian.org/debian}"
  echo 'Dpkg::Use-Pty "0";' >"$roots/$1/etc/apt/apt.conf.d/pty"
}

# A shell command in a root, with mounts and processes of its own, in a folder.
inside() {  # ROOT FOLDER COMMAND
  unshare --mount --pid --fork --kill-child bash -c 'mount -t proc proc "$0/proc"; exec chroot "$0" \
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive sh -ec "cd \"$1\" && $2"' \
    "$roots/$1" "$2" "$3"
}

# The picture PATH of a root shows what the command of this build renders.
checkPicture() {
  local path=$roots/$1 error
  build/chromeball render scenes/models/still-life.glb --probe probes/dusk.exr $small -o "$roots/expected.exr"
  error=$(build/chromeball image error --json "$path" "$roots/expected.exr")
  awk -F '[:,]' '/"relmse"/ { same = $2 < 1e-3 } END { exit !same }' <<<"$error" ||
    { echo "$path differs from a render of this build: $error" >&2; exit 1; }
}

# The command refuses a TIFF by one line, status 2 and the name of the package that is missing.
checkTiffIsRefused() {  # ROOT COMMAND
  cp tests/fuzz/seeds/image/a.tif "$roots/$1/srv/"
  inside "$1" /srv "{ $2 image view a.tif a.png 2>message && exit 1 || [ \$? = 2 ]; } &&
    [ \$(wc -l <message) = 1 ] && grep -q chromeball-tiff message"
}

testDeb() {
  makeBookworm deb
  cp build/package/*.deb "$roots/deb/srv/"
  inside deb /srv "apt-get update -q >/dev/null"
  local begin=$SECONDS installed
  inside deb /srv "apt-get install -qy ./chromeball_*.deb >/dev/null"
  installed=$SECONDS
  inside deb /srv "chromeball render /usr/$model --probe /usr/$probe --time 10 --denoise --quiet -o first.png"
  echo "Installed in $((installed - begin)) s, first picture after $((SECONDS - begin)) s (wanted: under 60)"
  inside deb /srv "chromeball render /usr/$model --probe /usr/$probe $small -o small.exr"
  checkPicture deb/srv/small.exr
  inside deb /usr "test -s share/man/man1/chromeball.1 -a -s lib/libchromeball.a &&
    test -s share/bash-completion/completions/chromeball -a -s share/zsh/vendor-completions/_chromeball &&
    test -s share/fish/vendor_completions.d/chromeball.fish -a -s include/chromeball/session.h"
  checkTiffIsRefused deb chromeball
  inside deb /srv "apt-get install -qy --no-install-recommends ./chromeball-tiff_*.deb >/dev/null &&
    chromeball image view a.tif a.png && test -s a.png"
  inside deb /srv "apt-get remove -qy chromeball >/dev/null && test -z \"\$(ls -d /usr/*/*chromeball* 2>/dev/null)\""
}

# Unpacked in a folder with a space; the command is started by a link, as another user.
testTarball() {  # ROOT
  local folder="/opt/my programs/chromeball"
  mkdir -p "$roots/$1$folder"
  tar xf build/package/chromeball-*.tar.gz --strip-components=1 -C "$roots/$1$folder"
  ln -s "$folder/bin/chromeball" "$roots/$1/usr/bin/"
  chmod 1777 "$roots/$1/srv"
  inside "$1" "$folder" "ldd bin/chromeball >/srv/libraries
    ! grep -v -e '=> $folder/' -e 'linux-vdso' -e '/ld-linux-' -e 'lib[cm]\.so\.6 => ' /srv/libraries"
  inside "$1" /srv "chroot --userspec=nobody / sh -ec 'cd /srv
    chromeball render \"$folder/$model\" --probe \"$folder/$probe\" $small -o small.exr'"
  checkPicture "$1/srv/small.exr"
  checkTiffIsRefused "$1" chromeball
}
testUbuntu() {
  # Debian has no package of Ubuntu's keys; TLS vouches for the mirror.
  local mirror=https://archive.ubuntu.com/ubuntu
  wget -q --spider --timeout=20 --tries=1 "$mirror/dists/noble/Release" || skip "$mirror is not reachable"
  makeRoot ubuntu noble "$mirror" --no-check-gpg
  testTarball ubuntu
}

# Does what the instructions of Dockerfile say; the last stage is then the root "image".
testDockerfile() {
  local stage folder=/ instruction rest from to
  while read -r instruction rest; do
    case $instruction in
      FROM)
        [[ $rest == debian:bookworm-slim* ]]
        stage=image folder=/
        [[ $rest != *" AS "* ]] || stage=image-${rest##* }
        makeBookworm "$stage"
        ;;
      COPY)
        if [[ $rest == --from=* ]]; then
          read -r from rest to <<<"${rest#--from=}"
          mkdir -p "$roots/$stage$to"
          cp -a "$roots/image-$from$rest/." "$roots/$stage$to"
        else
          read -r _ to <<<"$rest"
          mkdir -p "$roots/$stage$to"
          tar c --exclude-from=<(sed 's|^/|./|' .dockerignore) --anchored . | tar x --no-same-owner -C "$roots/$stage$to"
        fi
        ;;
      WORKDIR) folder=$rest; mkdir -p "$roots/$stage$folder" ;;
      RUN) echo "$stage: $rest"; inside "$stage" "$folder" "$rest" ;;
      ENTRYPOINT) [[ $rest == '["chromeball"]' ]] ;;
      '' | '#'*) ;;
      *) echo "Dockerfile: $instruction is unknown to this script" >&2; exit 1 ;;
    esac
  done < <(sed -e ':join' -e '/^[^#].*\\$/{N;s/\\\n//;b join' -e '}' Dockerfile)
  inside image "$folder" "chromeball render /usr/$model --probe /usr/$probe $small -o small.exr"
  checkPicture "image$folder/small.exr"
}

((EUID == 0)) || skip "it needs root"
installPackages debootstrap wget || skip "it needs debootstrap"
case ${1:-} in
  deb) testDeb ;;
  tarball) makeBookworm tarball; testTarball tarball ;;
  ubuntu) testUbuntu ;;
  dockerfile) testDockerfile ;;
  *) sed -n '3,7s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
echo "$1: passed"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the files of a release in build/package and prints their SHA-256 sums: Debian's packages
# (tools/cmake/package.cmake) and chromeball-VERSION-x86_64.tar.gz, which runs from any folder where glibc is
# 2.36 or newer: it holds the command with all libraries that it loads but glibc's, and their licences. The
# module that reads TIFF is left out: what it loads is 364 MB, 101 MB compressed. As root or with sudo on
# Debian 12, whose glibc is the oldest. Arguments go to tools/build.sh.
set -euo pipefail
cd "$(dirname "$0")/../.."
newest=2.36 limit=80000000

source tools/scripts/packages.sh
installPackages binutils dpkg-dev file patchelf
tools/build.sh --target chromeball "$@"
rm -rf build/package
(cd build && cpack >/dev/null)

version=$(build/chromeball --version | grep -o '[0-9][0-9.]*' | head -n 1)
name=chromeball-$version-x86_64
root=build/package/$name
cmake --install build --prefix "$root" --component chromeball --strip >/dev/null
rm -r "$root"/{include,lib}
mkdir -p "$root"/{lib,share/doc/chromeball/libraries}
ldd "$root/bin/chromeball" | awk '$2 == "=>" { print $3 }' |
  grep -Ev '/lib(c|m|dl|pthread|rt|mvec)\.so\.' | while read -r library; do
  copy=$root/lib/$(basename "$library")
  cp -L "$library" "$copy"
  strip --strip-unneeded "$copy"
  patchelf --set-rpath "\$ORIGIN" "$copy"
  package=$(dpkg-query -S "*/x86_64-linux-gnu/$(basename "$(realpath "$library")")" | sed 's/:.*//;q')
  cp "/usr/share/doc/$package/copyright" "$root/share/doc/chromeball/libraries/$package"
done

needed=$(objdump -T "$root"/bin/* "$root"/lib/* | grep -o 'GLIBC_2\.[0-9]*' | sort -Vu | tail -n 1)
if [[ $(printf '%s\n' "GLIBC_$newest" "$needed" | sort -V | tail -n 1) != "GLIBC_$newest" ]]; then
  echo "The libraries of this machine need $needed: make the release on Debian 12 (GLIBC_$newest)" >&2
  exit 1
fi
tar --create --directory build/package --sort=name --owner=0 --group=0 --numeric-owner \
  --mtime="$(git log -1 --format=%cI)" "$name" | gzip -9n >"$root.tar.gz"
size=$(stat -c %s "$root.tar.gz")
if ((size > limit)); then
  echo "$root.tar.gz has $size bytes, more than $limit" >&2
  exit 1
fi
rm -r "$root" build/package/_CPack_Packages
cd build/package
sha256sum -- *

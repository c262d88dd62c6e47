#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the program under sanitizers, in builds of its own (presets asan and tsan; tests/ENVELOPE.md):
#   tools/scripts/sanitize.sh address [GOOGLETEST ARGUMENT...]  AddressSanitizer and UBSan: all tests,
#                                                               and the command where they run it
#   tools/scripts/sanitize.sh thread [MODEL...]                 ThreadSanitizer: renders, and the other
#                                                               commands that use threads
# Both need the packages that tools/build.sh installs.
set -euo pipefail
cd "$(dirname "$0")/../.."
mode=${1:?address or thread}
shift
build=$PWD/build/$mode
suppressions=$PWD/tests/sanitizers

configureAndBuild() {  # PRESET TARGET
  cmake --preset "$1" >/dev/null
  cmake --build "$build" --parallel "$(nproc)" --target "$2"
}

# oneTBB from Debian's sources, instrumented: ThreadSanitizer must see how it synchronises threads.
buildOneTbb() {
  local work=$build/onetbb
  [[ -e $work/libtbb.so.12 ]] && return
  mkdir -p "$work"/{parts,lists}
  sed 's/^Types: deb$/Types: deb-src/' /etc/apt/sources.list.d/debian.sources >"$work/parts/src.sources"
  local apt=(apt-get -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/parts"
    -o Dir::State::lists="$work/lists")
  "${apt[@]}" update -q
  (cd "$work" && "${apt[@]}" source -q --download-only onetbb && tar xf onetbb_*.orig.tar.*)
  cmake -S "$work"/oneTBB-* -B "$work/build" -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBB_SANITIZE=thread \
    -DCMAKE_BUILD_TYPE=RelWithDebInfo >/dev/null
  cmake --build "$work/build" --parallel "$(nproc)" --target tbb
  cp "$(find "$work/build" -name libtbb.so.12)" "$work/"
}

case $mode in
address)
  configureAndBuild asan tests
  LSAN_OPTIONS=suppressions=$suppressions/leak.txt UBSAN_OPTIONS=print_stacktrace=1 \
    "$build/tests" "$@"
  ;;
thread)
  buildOneTbb
  configureAndBuild tsan chromeball
  out=$build/out
  mkdir -p "$out"
  export LD_LIBRARY_PATH=$build/onetbb
  # Reports go to files: our readers redirect standard error, which would hide them.
  export TSAN_OPTIONS="suppressions=$suppressions/thread.txt log_path=$out/report"
  rm -f "$out"/report*
  render() { "$build/chromeball" render "$@" --threads 4 --samples 4 --quiet -o "$out/a.exr"; }
  probe=$out/probe.exr
  "$build/chromeball" probe synth sun-sky "$probe" --size 256x128
  for model in scenes/models/still-life.glb "$@"; do
    render "$model" --probe "$probe" --size 96x72 --aov albedo,normal,depth,variance
  done
  for strategy in bsdf uniform suns product median-cut:16 irradiance-fit:4 kollig-keller:8; do
    render scenes/models/pillars.gltf --probe "$probe" --size 96x72 --strategy "$strategy"
  done
  render scenes/terrace.toml
  "$build/chromeball" probe convert "$probe" "$out/b.exr" --to angular
  "$build/chromeball" probe irradiance "$probe" "$out/b.exr" --size 64x32
  "$build/chromeball" lights-error "$probe" --methods median-cut,penrose --counts 2,4 --normals 1280
  "$build/chromeball" compare scenes/models/pillars.gltf --probe "$probe" --size 32x24 --quiet \
    --strategies importance,uniform --samples 1,4 --repeats 3 --reference-samples 16 -o "$out/compare"
  if compgen -G "$out/report*" >/dev/null; then
    cat "$out"/report* >&2
    exit 1
  fi
  echo "No data race."
  ;;
*)
  echo "address or thread, not $mode" >&2
  exit 2
  ;;
esac

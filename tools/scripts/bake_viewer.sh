#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows baked models by three.js in headless Chromium and prints their mean difference from renders
# of the same view, as a part of white (sRGB): a lightmap and vertex colours without light, and the
# model's own materials with the .exr as lightMap. Exit status 1 if one exceeds its bound.
#
#   tools/scripts/bake_viewer.sh [FOLDER]     FOLDER keeps the files, and screenshots
#
# Needs chromium, npm and python3; installs the packages of tests/npm, three among them, in the folder,
# unless they are there.
# CHROMEBALL is the command (default build/chromeball); MODEL, CAMERA and PROBE another scene;
# SAMPLES those of each texel, vertex and pixel (256); TEXELS the side of the lightmaps (1024).
set -euo pipefail
cd "$(dirname "$0")/../.."

chromeball=${CHROMEBALL:-build/chromeball}
model=${MODEL:-scenes/models/pillars.gltf} probe=${PROBE:-probes/noon.exr}
camera=${CAMERA-Front}
samples=${SAMPLES:-256} texels=${TEXELS:-1024} width=480 height=320
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) ||
  { echo "bake_viewer.sh: needs chromium" >&2; exit 2; }
keeps=$#
folder=${1:-$(mktemp -d)}
mkdir -p "$folder"
server=
cleanUp() {
  [ -z "$server" ] || kill "$server" 2> /dev/null || true
  [ "$keeps" -gt 0 ] || rm -rf "$folder"
}
trap cleanUp EXIT

if [ ! -d "$folder/node_modules/three" ]; then
  cp tests/npm/package*.json "$folder"
  npm ci --prefix "$folder" --silent --no-audit --no-fund
fi
cp tools/scripts/bake_viewer.html "$folder"

light=(--probe "$probe" --quiet)
view=()
[ -z "$camera" ] || view=(--camera "$camera")
bake() { "$chromeball" bake "$model" "${light[@]}" "${view[@]}" --samples "$samples" "${@:2}" -o "$folder/$1"; }
bake lightmap.glb --size "$texels"
bake vertices.glb --to vertices
bake kept.glb --size "$texels" --keep-materials
scaleOf() {
  python3 - "$folder/$1" <<'PY'
import json, struct, sys
glb = open(sys.argv[1], 'rb').read()
text = glb[20:20 + struct.unpack('<I', glb[12:16])[0]]
print(json.loads(text)['extras']['chromeball']['scale'])
PY
}
# render SCALE: what white stands for.
render() {
  "$chromeball" render "$model" "${light[@]}" "${view[@]}" --size ${width}x$height --samples "$samples" \
    --denoise --transparent --exposure "$(python3 -c "import math; print(-math.log2($1))")" \
    -o "$folder/render-$1.png"
}

# Prints its port, and serves the folder.
python3 -u - "$folder" > "$folder/port" <<'PY' &
import functools, http.server, sys
class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_): pass
server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), functools.partial(Quiet, directory=sys.argv[1]))
print(server.server_port)
server.serve_forever()
PY
server=$!
until [ -s "$folder/port" ]; do sleep 0.1; done
address=http://127.0.0.1:$(cat "$folder/port")/bake_viewer.html

status=0
# show NAME BOUND SCALE PARAMETERS
show() {
  [ -e "$folder/render-$3.png" ] || render "$3"
  local page="$address?model=$1.glb&render=render-$3.png&scale=$3&width=$width&height=$height$4"
  local options=(--headless --no-sandbox --use-gl=angle --use-angle=swiftshader
    --enable-unsafe-swiftshader --ignore-gpu-blocklist --no-first-run
    --disable-quic --disable-background-networking --disable-component-update --disable-sync
    --virtual-time-budget=30000 --user-data-dir="$folder/profile" --window-size=$width,$height --hide-scrollbars)
  local found attempt
  for attempt in 1 2 3; do  # a busy machine may end the page before it has drawn
    found=$("$chromium" "${options[@]}" --dump-dom "$page" 2> "$folder/log" |
      sed -n 's/.*<pre id="result">\(.*\)<\/pre>.*/\1/p')
    [[ $found != compared* ]] || break
  done
  [ "$keeps" -eq 0 ] ||
    "$chromium" "${options[@]}" --screenshot="$folder/$1.png" "$page" 2>> "$folder/log" || true
  case $found in
    compared*) ;;
    *) echo "$1: ${found:-no picture; see $folder/log}"; status=1; return ;;
  esac
  python3 - "$1" "$2" "${found#compared }" <<'PY' || status=1
import json, sys
name, bound, found = sys.argv[1], float(sys.argv[2]), json.loads(sys.argv[3])
print(f"{name:10} mean difference {found['mean']:.4f} (bound {bound}), bias {found['bias']:+.4f}, "
      f"worst {found['worst']:.3f}, {found['pixels']:.0f} pixels")
sys.exit(found['mean'] > bound)
PY
}
scale=$(scaleOf lightmap.glb)
show lightmap 0.02 "$scale" ""
show kept 0.02 "$scale" "&lightmap=kept.exr"
show vertices 0.2 "$(scaleOf vertices.glb)" ""
exit $status

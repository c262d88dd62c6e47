#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders a thumbnail of every glTF model below a folder, and writes a page that shows it beside the
# model's own screenshot (screenshot/screenshot.* in the model's folder or the one above).
#
#   tools/scripts/gltf_gallery.sh FOLDER OUT [option of chromeball render ...]
#
# OUT/index.html also lists warnings, and models that were refused. Without --probe among the options
# a synthetic studio lights the models.
set -euo pipefail
(($# >= 2)) || { sed -n '3,9s/^# \{0,1\}//p' "$0"; exit 2; }
folder=$(realpath "$1") out=$2
shift 2
chromeball=$(realpath "$(dirname "$0")/../../build/chromeball")
[[ -x $chromeball ]] || { echo "build/chromeball is missing: run tools/build.sh" >&2; exit 1; }
mkdir -p "$out"

options=("$@")
given() { [[ " ${options[*]} " == *" $1 "* ]]; }
given --size || options+=(--size 320x240)
given --samples || options+=(--samples 64)
given --exposure || options+=(--exposure -1)  # keeps white objects in the studio below white
if ! given --probe; then
  "$chromeball" probe synth studio "$out/studio.exr" >/dev/null
  options+=(--probe "$out/studio.exr")
fi

escape() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/"/\&quot;/g'; }

# The file of a model's screenshot, or nothing.
screenshot() {
  local folder
  for folder in "$(dirname "$1")" "$(dirname "$1")/.."; do
    find "$folder/screenshot" -maxdepth 1 -iname 'screenshot.*' 2>/dev/null | sort | head -n 1
  done | head -n 1
}

# One table cell with an image, or a dash.
cell() {
  if [[ -n $1 ]]; then
    printf '<td><img src="%s" alt="" width="320"></td>' "$(printf %s "$1" | escape)"
  else
    printf '<td>&mdash;</td>'
  fi
}

{
  cat <<'HEAD'
<!doctype html><meta charset="utf-8"><title>Models</title>
<style>body{font:14px sans-serif;background:#222;color:#ddd}td{vertical-align:top;padding:4px 8px}
td:first-child{max-width:26em;overflow-wrap:anywhere}.no{color:#f88}</style>
<table><tr><th>model<th>chromeball<th>the model's screenshot
HEAD
  count=0 failed=0
  while IFS= read -r model; do
    name=${model#"$folder"/}
    image="$(printf %s "$name" | tr -c 'A-Za-z0-9.\n' _).png"
    state=yes shown=$image
    if ! messages=$("$chromeball" render "$model" -o "$out/$image" --quiet "${options[@]}" 2>&1); then
      state=no shown='' failed=$((failed + 1))
    fi
    count=$((count + 1))
    printf '<tr class="%s"><td><b>%s</b><br>%s</td>%s%s\n' "$state" "$(printf %s "$name" | escape)" \
      "$(printf %s "${messages//"$model"/}" | escape)" "$(cell "$shown")" \
      "$(cell "$(screenshot "$model")")"
    printf '%s: %s%s\n' "$count" "$name" "${messages:+ [$(head -n 1 <<<"${messages//"$model"/}")]}" >&2
  done < <(find "$folder" \( -iname '*.gltf' -o -iname '*.glb' \) -type f | sort)
  echo '</table>'
  echo "$count models, $failed refused: $out/index.html" >&2
} >"$out/index.html"

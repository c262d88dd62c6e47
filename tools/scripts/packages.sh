# SPDX-License-Identifier: Apache-2.0
# Sourced. installPackages NAME... installs those of Debian's packages (also Ubuntu's) that this machine
# lacks, as root or with sudo; if that fails it says so, with status 1. Elsewhere it does nothing: what
# needs them says what is missing.
installPackages() {
  command -v dpkg-query >/dev/null || return 0
  local package missing=() asRoot=() log
  for package; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed* ]] ||
      missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  log=$(mktemp)
  if ((EUID == 0)) || sudo -n true 2>/dev/null || { command -v sudo >/dev/null && [[ -t 0 ]]; }; then
    ((EUID == 0)) || asRoot=(sudo)
    echo "Installing ${missing[*]}"
    # Old lists may do where they cannot be updated.
    "${asRoot[@]}" apt-get update -q >"$log" 2>&1 || true
    if "${asRoot[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -qy --no-install-recommends "${missing[@]}" >>"$log" 2>&1; then
      rm "$log"
      return 0
    fi
  fi
  tail -n 20 "$log" >&2
  rm "$log"
  echo "These packages (Debian's names) are needed, and cannot be installed here: ${missing[*]}" >&2
  return 1
}

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what some tests use, and are skipped without (Debian and Ubuntu, as root or with sudo): a
# browser for the pages, Slurm for the farm (one_machine_slurm.sh starts it), and, into build/npm, the
# packages of tests/npm in the versions and with the checksums of its package-lock.json.
set -euo pipefail
cd "$(dirname "$0")/../.."

source tools/scripts/packages.sh
packages=(chromium git munge python3 slurm-wlm)
# A Node.js that is there, of whatever origin, will do.
command -v npm >/dev/null || packages+=(nodejs npm)
installPackages "${packages[@]}"
mkdir -p build/npm
cp tests/npm/package.json tests/npm/package-lock.json build/npm
npm ci --prefix build/npm --silent --no-audit --no-fund

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what some tests use, and are skipped without (Debian and Ubuntu, as root or with sudo): a
# browser for the pages, Slurm for the farm (one_machine_slurm.sh starts it), into build/npm the packages of
# tests/npm in the versions and with the checksums of its package-lock.json, and into build/venv a Python that
# can build and test the module (tools/build.sh -DCHROMEBALL_PYTHON=ON -DPython_EXECUTABLE=$PWD/build/venv/bin/python).
set -euo pipefail
cd "$(dirname "$0")/../.."

source tools/scripts/packages.sh
packages=(chromium git munge python3 python3-dev python3-venv slurm-wlm)
# A Node.js that is there, of whatever origin, will do.
command -v npm >/dev/null || packages+=(nodejs npm)
installPackages "${packages[@]}"
mkdir -p build/npm
cp tests/npm/package.json tests/npm/package-lock.json build/npm
npm ci --prefix build/npm --silent --no-audit --no-fund
python3 -m venv build/venv
build/venv/bin/pip install --quiet --disable-pip-version-check -r python/tests/requirements.txt

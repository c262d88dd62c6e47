#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds and runs the micro-benchmarks. Arguments go to Google Benchmark (--benchmark_filter=REGEX).
set -euo pipefail
cd "$(dirname "$0")/../.."

tools/build.sh
build/benchmarks --benchmark_counters_tabular=true "$@"

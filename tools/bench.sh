#!/usr/bin/env bash
# Builds and runs the micro-benchmarks. Arguments go to Google Benchmark (--benchmark_filter=REGEX).
set -euo pipefail
cd "$(dirname "$0")/.."

tools/build.sh
build/benchmarks --benchmark_counters_tabular=true "$@"

#!/usr/bin/env bash
# The whole job: build, Tables 1 and 2, Figures 2 and 3, fluence and a sweep, into out/.
# Usage: scripts/demo.sh
set -euo pipefail
# shellcheck source=scripts/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
(($# == 0)) || die "usage: scripts/demo.sh"

need "${build_packages[@]}" gnuplot-nox fonts-dejavu-core
configure release -DPPSCAT_OUTPUT_DIR="$root/out"
cmake --build --preset release --target ppscat_cli

say "tables, figures and a sweep, by the commands in plots/CMakeLists.txt"
cmake --build --preset release --target figures sweep

say "the results"
printf '%s\n' "$root"/out/*.csv "$root"/out/*.png

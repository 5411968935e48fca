#!/usr/bin/env bash
# Build and test: the sanitizers first, then the plain build.
# Usage: scripts/test.sh [--all]        --all adds the slow tests and, with clang, TSan
set -euo pipefail
# shellcheck source=scripts/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

select=(--label-exclude slow)
packages=("${build_packages[@]}" clang-format libopenmpi-dev openmpi-bin)
case "$#:${1-}" in
0:) ;;
1:--all) select=() packages+=(gnuplot-nox fonts-dejavu-core clang libomp-dev) ;;
*) die "usage: scripts/test.sh [--all]" ;;
esac

need "${packages[@]}"
for preset in asan dev; do
    configure "$preset"
    cmake --build --preset "$preset"
    ctest --preset "$preset" "${select[@]}"
done

if [[ ${1-} == --all ]]; then # threads: the fast tests, some twenty times slower
    configure tsan
    cmake --build --preset tsan
    ctest --preset tsan --label-exclude 'slow|package'
fi

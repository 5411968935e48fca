#!/usr/bin/env bash
# Other programs for the same problem, beside ppscat on one core: speed, error, failures.
# Usage: scripts/bench-peers.sh [--quick] [BUILD-FOLDER]
#
# Optional, and no part of the build: ppscat needs neither Python nor the network. The
# peers come from PyPI, pinned, into build/peers/venv; results go to build/peers:
# chart.csv (the columns of `ppscat chart`) and the tables of docs/peers.md.
set -euo pipefail
# shellcheck source=scripts/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
    printf 'usage: scripts/bench-peers.sh [--quick] [BUILD-FOLDER]\n' >&2
    exit 2
}

quick=()
if [[ ${1-} == --quick ]]; then
    quick=(--quick)
    shift
fi
if (($# > 1)) || [[ ${1-} == -* ]]; then
    usage
elif (($#)) && [[ ! -d $1 ]]; then
    printf 'error: BUILD-FOLDER is a folder with libppscat.so in it, not %s\n' "$1" >&2
    exit 2
fi

out=$root/build/peers
peers=$root/scripts/peers
need "${build_packages[@]}" python3 python3-venv
if (($#)); then
    build=$(cd "$1" && pwd)
else
    build=$root/build/release
    configure release
    cmake --build --preset release --target ppscat
fi
[[ -e $build/libppscat.so ]] || die "no libppscat.so in $build"
mkdir -p "$out"

say "peers, in build/peers/venv"
venv=$out/venv
[[ -x $venv/bin/pip ]] || python3 -m venv "$venv"
while read -r pinned; do
    "$venv/bin/pip" install -q --disable-pip-version-check --only-binary :all: \
        -c "$peers/requirements.txt" "$pinned" ||
        say "cannot be had, skipped: $pinned"
done < <(grep -v '^#' "$peers/requirements.txt")

say "ppscat's timing loops"
"${CC:-cc}" -std=c11 -O2 -D_POSIX_C_SOURCE=200809L -shared -fPIC -I "$root/include" \
    -o "$out/peers_ppscat.so" "$root/tests/bench/peers_ppscat.c" \
    -L "$build" -lppscat -Wl,-rpath,"$build"

# One thread, one core: the last of those we may use.
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 PYTHONDONTWRITEBYTECODE=1
cores=$(taskset -cp $$)
core=${cores##*[ ,-]}
say "side by side on core $core"
taskset -c "$core" "$venv/bin/python" "$peers/bench.py" "${quick[@]}" \
    --shim "$out/peers_ppscat.so" --out "$out" \
    --hard-cases "$root/data/reference/discrete_hard_cases.csv"

say "cdisort itself, compiled -O3 and called from C, beside ppscat"
nanodisort=$(grep '^nanodisort==' "$peers/requirements.txt")
if "$venv/bin/pip" download -q --disable-pip-version-check --no-deps \
    --no-binary nanodisort -d "$out" "$nanodisort"; then
    tar -xzf "$out/nanodisort-${nanodisort#*==}.tar.gz" -C "$out"
    cdisort=$(dirname "$(find "$out/nanodisort-${nanodisort#*==}" -name cdisort.c)")
    cmake -S "$root" -B "$build" -DPPSCAT_CDISORT="$cdisort" >/dev/null
    cmake --build "$build" --target ppscat-bench
    taskset -c "$core" "$build/tests/bench/ppscat-bench" "$out/cdisort.csv" \
        2>/dev/null | tee "$out/cdisort.txt"
else
    say "its source cannot be had, skipped"
fi
say "the results"
printf '%s\n' "$out"/*.csv "$out"/*.md

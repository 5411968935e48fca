# Shared by the scripts beside it; sourced, never run.
# shellcheck shell=bash disable=SC2034

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_packages=(cmake ninja-build gcc libc6-dev pkg-config
    liblapacke-dev libopenblas-dev libgsl-dev librandom123-dev
    libjansson-dev libnetcdf-dev libcmocka-dev
    libassimp-dev libembree-dev libpng-dev libturbojpeg0-dev
    libegl-dev libgl1-mesa-dri libepoxy-dev libglfw3-dev libx11-dev xvfb xauth xdotool x11-utils)

say() { printf '== %s\n' "$*"; }

die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

# need PACKAGE...: install by apt those that are missing; touch nothing when none is.
need() {
    local package missing=() sudo=()
    command -v dpkg-query >/dev/null ||
        die "this script installs Debian packages; elsewhere install the likes of: $*"
    for package; do
        dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null |
            grep -qx installed || missing+=("$package")
    done
    ((${#missing[@]})) || return 0

    if ((EUID != 0)); then
        command -v sudo >/dev/null ||
            die "missing packages (${missing[*]}): run as root, or install sudo"
        sudo=(sudo)
    fi
    say "installing ${missing[*]}"
    "${sudo[@]}" apt-get update -qq
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# configure PRESET [CMAKE-OPTION...], from anywhere; leaves us at the root.
configure() {
    say "preset $1, in build/$1"
    cd "$root" || return
    cmake --preset "$@" >/dev/null
}

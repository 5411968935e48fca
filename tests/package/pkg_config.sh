#!/bin/sh
# pkg_config.sh LIBDIR SOURCE PROGRAM COMPILER [FLAG...]: compile, link and run by ppscat.pc.
set -eu
libdir=$1 source=$2 program=$3
shift 3
PKG_CONFIG_PATH=$libdir/pkgconfig
export PKG_CONFIG_PATH
# shellcheck disable=SC2046 # the flags are words
"$@" -std=c11 "$source" -o "$program" $(pkg-config --cflags --libs ppscat) -lm
LD_LIBRARY_PATH=$libdir "$program"

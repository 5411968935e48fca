#!/bin/sh
# readme.sh README PROGRAM.c: the C program of the README is that file, word for word.
set -eu
awk '/^```c$/ { code = 1; next } /^```/ { if (code) exit } code' "$1" | diff -u "$2" -

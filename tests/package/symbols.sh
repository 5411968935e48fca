#!/bin/sh
# symbols.sh LIBRARY: every symbol it exports starts with pps_, and there are some.
set -eu
symbols=$(nm --dynamic --defined-only --format=posix "$1" | cut -d ' ' -f 1)
foreign=$(printf '%s\n' "$symbols" | grep -v '^pps_' || true)
if [ -n "$foreign" ]; then
    printf 'exported, but not pps_:\n%s\n' "$foreign"
    exit 1
fi
printf '%s\n' "$symbols" | grep -qx pps_version

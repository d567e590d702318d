#!/bin/sh
# run.sh BUILD FOLDER...: runs tests/FOLDER's programs (test_*.c, built) and scripts (*.sh, *.py), each of which prints
# TAP lines ("ok ...", "not ok ..."), and ends with "N passed, N failed". A program that dies without saying "not ok"
# counts as one failure. As many run side by side as there are cores; peers one by one, for they are systems of their
# own.
set -u
top=$(cd "$(dirname "$0")/.." && pwd)

# One program, in an empty folder of its own: a line for its result, and what it said if that is bad.
if [ "$1" = --one ]; then
    t=$2 name=$3
    mkdir -p "$HOODOO_SCRATCH/$name" && cd "$HOODOO_SCRATCH/$name" || exit 1
    log=$HOODOO_SCRATCH/$name.log
    case $t in *.sh) run="sh $t" ;; *.py) run="/usr/bin/python3 $t" ;; *) run=$t ;; esac
    start=$(date +%s)
    $run >"$log" 2>&1
    code=$?
    ok=$(grep -c '^ok ' "$log")
    bad=$(grep -c '^not ok ' "$log")
    [ $code -ne 0 ] && [ "$bad" = 0 ] && bad=1
    [ $((ok + bad)) = 0 ] && bad=1
    {
        echo "$name: $ok passed, $bad failed ($(($(date +%s) - start)) s)"
        [ "$bad" = 0 ] || sed 's/^/    /' "$log" | tail -n 60
    } >"$log.said"
    cat "$log.said" # at once, so that the lines of two programs stay apart
    echo "$ok $bad" >"$log.count"
    cd "$top" && rm -rf "${HOODOO_SCRATCH:?}/$name"
    exit 0
fi

build=$(realpath "$1")
shift
export HOODOO="$build/hoodoo" HOODOO_TOP="$top" CMOCKA_MESSAGE_OUTPUT=tap
HOODOO_SCRATCH=$(mktemp -d "${TMPDIR:-/tmp}/hoodoo-test.XXXXXX")
export HOODOO_SCRATCH
trap 'rm -rf "$HOODOO_SCRATCH"' EXIT
list() {
    for folder in "$@"; do
        for t in "$build/tests/$folder"/test_* "$top/tests/$folder"/*.sh "$top/tests/$folder"/*.py; do
            case $t in *.d | *.o) continue ;; esac
            [ -f "$t" ] && printf '%s\0%s\0' "$t" "$folder/$(basename "$t")"
        done
    done
}
at_once=$(nproc)
[ "$*" = peers ] && at_once=1
list "$@" | xargs -0 -n 2 -P "$at_once" sh "$top/tests/run.sh" --one
find "$HOODOO_SCRATCH" -name '*.count' -exec cat {} + |
    awk '{ passed += $1; failed += $2 } END { if (NR == 0) failed = 1; printf "%d passed, %d failed\n", passed, failed; exit failed > 0 }'

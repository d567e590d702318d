#!/bin/sh
# run.sh BUILD FOLDER...: runs tests/FOLDER's programs (test_*.c, built) and scripts (*.sh, *.py), each of which prints
# TAP lines ("ok ...", "not ok ..."), and ends with "N passed, N failed". A program that dies without saying "not ok"
# counts as one failure.
set -u
build=$(realpath "$1")
shift
top=$(cd "$(dirname "$0")/.." && pwd)
export HOODOO="$build/hoodoo" HOODOO_TOP="$top" CMOCKA_MESSAGE_OUTPUT=tap
passed=0 failed=0
scratch=$(mktemp -d "${TMPDIR:-/tmp}/hoodoo-test.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
for folder in "$@"; do
    for t in "$build/tests/$folder"/test_* "$top/tests/$folder"/*.sh "$top/tests/$folder"/*.py; do
        [ -f "$t" ] || continue
        name=$folder/$(basename "$t")
        case $t in *.d | *.o) continue ;; *.sh) run="sh $t" ;; *.py) run="/usr/bin/python3 $t" ;; *) run=$t ;; esac
        mkdir -p "$scratch/$name" && cd "$scratch/$name" || exit 1
        start=$(date +%s)
        $run >"$scratch/log" 2>&1
        code=$?
        ok=$(grep -c '^ok ' "$scratch/log")
        bad=$(grep -c '^not ok ' "$scratch/log")
        [ $code -ne 0 ] && [ "$bad" = 0 ] && bad=1
        [ $((ok + bad)) = 0 ] && bad=1
        passed=$((passed + ok)) failed=$((failed + bad))
        echo "$name: $ok passed, $bad failed ($(($(date +%s) - start)) s)"
        [ "$bad" = 0 ] || { sed 's/^/    /' "$scratch/log" | tail -n 60; }
        cd "$top" && rm -rf "${scratch:?}/$name"
    done
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]

#!/bin/sh
# run.sh BUILD FOLDER|PROGRAM...: runs tests/FOLDER's programs (test_*.c, built) and scripts (*.sh, *.py), or the one
# named, as unit/test_job or cli/aov.py. Each prints TAP lines ("ok ...", "not ok ...", either with "# skip ..."); the last
# line here is "N passed, N failed". What is skipped counts as neither; the names of those that skipped something go to
# BUILD/skipped, for root may be able to run them. A program that dies without saying "not ok" counts as one failure. As
# many run side by side as there are cores. What campaigns of faults say ("# fault | ...") must be what tests/README.md has (faults.sh).
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
    times >"$log.times" # the second line is of what has ended here: user, system, as 1m2.30s
    cpu=$(awk 'NR == 2 { gsub(/s/, ""); split($1, u, "m"); split($2, s, "m"); printf "%.0f", 60 * (u[1] + s[1]) + u[2] + s[2] }' "$log.times")
    skipped=$(grep -ciE '^(not )?ok .*# ?skip' "$log")
    ok=$(grep -iE '^ok ' "$log" | grep -civE '# ?skip')
    bad=$(grep -E '^not ok ' "$log" | grep -civE '# ?skip')
    [ $code -ne 0 ] && [ "$bad" = 0 ] && bad=1
    [ $((ok + bad + skipped)) = 0 ] && bad=1
    {
        echo "$name: $ok passed, $bad failed$([ "$skipped" = 0 ] || echo ", $skipped skipped") ($cpu s of CPU in $(($(date +%s) - start)) s)"
        [ "$bad" != 0 ] || grep -iE '# ?skip' "$log" | sed 's/^/    /'
        [ "$bad" = 0 ] || sed 's/^/    /' "$log" | tail -n 200
    } >"$log.said"
    cat "$log.said" # at once, so that the lines of two programs stay apart
    echo "$ok $bad $skipped $name $cpu" >"$log.count"
    sed -n "s!^# fault \(.*\)!\1 \`sh tests/run.sh build $name\` |!p" "$log" >"$log.faults"
    cd "$top" && rm -rf "${HOODOO_SCRATCH:?}/$name"
    exit 0
fi

build=$(realpath "$1")
shift
export HOODOO="$build/hoodoo" HOODOO_LIBEXEC="$build" HOODOO_TOP="$top" CMOCKA_MESSAGE_OUTPUT=tap
[ -x "$build/hoodoo-read" ] || HOODOO_LIBEXEC=$top/build # the sanitizers' builds have none
export PYTHONPATH="$top/tests/lib" PYTHONDONTWRITEBYTECODE=1
HOODOO_SCRATCH=$(mktemp -d "${TMPDIR:-/tmp}/hoodoo-test.XXXXXX")
export HOODOO_SCRATCH
export MESA_SHADER_CACHE_DIR="$HOODOO_SCRATCH/shaders" # so that a kernel is compiled once, and not what another run left
trap 'rm -rf "$HOODOO_SCRATCH"' EXIT
list() {
    for folder in "$@"; do
        for t in "$build/tests/$folder"/test_* "$top/tests/$folder"/*.sh "$top/tests/$folder"/*.py; do
            case $t in *.d | *.o) continue ;; esac
            [ -f "$t" ] && printf '%s\t%s\n' "$t" "$folder/$(basename "$t")"
        done
        for t in "$build/tests/$folder" "$top/tests/$folder"; do
            [ -f "$t" ] && printf '%s\t%s\n' "$t" "$folder"
        done
    done
}
# Without those that are named in the file $HOODOO_TEST_BUT, one a line, if there is such.
wanted() {
    if [ -n "${HOODOO_TEST_BUT:-}" ]; then awk -F '\t' 'NR == FNR { but[$1]; next } !($2 in but)' "$HOODOO_TEST_BUT" -; else cat; fi
}
at_once=$(nproc)
# Those that take long start first: the last to start would be alone at the end.
list "$@" | wanted | awk -F '\t' 'NR == FNR { rank[$1] = NR; next } { print ($2 in rank ? rank[$2] : 1e6) "\t" $0 }' "$top/tests/longest" - |
    sort -s -n -k 1,1 | cut -f 2- | tr '\t' '\n' | xargs -d '\n' -r -n 2 -P "$at_once" sh "$top/tests/run.sh" --one
find "$HOODOO_SCRATCH" -name '*.count' -exec cat {} + >"$HOODOO_SCRATCH/counts"
awk '$3 > 0 { print $4 }' "$HOODOO_SCRATCH/counts" >"$build/skipped"
find "$HOODOO_SCRATCH" -name '*.faults' -exec cat {} + | sort >"$HOODOO_SCRATCH/faults"
sh "$top/tests/faults.sh" "$HOODOO_SCRATCH/faults" >>"$HOODOO_SCRATCH/counts"
echo "of CPU took most, in seconds:$(sort -k 5nr "$HOODOO_SCRATCH/counts" | head -n 10 | awk '{ printf " %s %s", $4, $5 }')"
awk '{ passed += $1; failed += $2; skipped += $3 }
    END {
        if (NR == 0) failed = 1
        if (skipped > 0) printf "%d skipped\n", skipped
        printf "%d passed, %d failed\n", passed, failed
        exit failed > 0
    }' "$HOODOO_SCRATCH/counts"

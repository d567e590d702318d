#!/bin/sh
# run.sh BUILD FOLDER|PROGRAM...: runs the programs (test_*.c, built) and scripts (*.sh, *.py) in tests/FOLDER, or a single one,
# such as unit/test_job or cli/aov.py. Each prints TAP lines ("ok ...", "not ok ...", either with "# skip ..."). The last line of
# output is "N passed, N failed". Skipped checks count as neither; the names of programs that skip any go to BUILD/skipped,
# since root may be able to run them. A program that fails without "not ok" counts as one failure. As many programs run at a
# time as there are cores. Rows of fault campaigns ("# fault | ...") must equal those in tests/README.md (faults.sh).
set -u
top=$(cd "$(dirname "$0")/.." && pwd)

# Runs one program in an empty folder and prints a line with its result, and its output if it fails.
if [ "$1" = --one ]; then
    t=$2 name=$3
    mkdir -p "$HOODOO_SCRATCH/$name" && cd "$HOODOO_SCRATCH/$name" || exit 1
    log=$HOODOO_SCRATCH/$name.log
    case $t in *.sh) run="sh $t" ;; *.py) run="/usr/bin/python3 $t" ;; *) run=$t ;; esac
    start=$(date +%s)
    $run >"$log" 2>&1
    code=$?
    times >"$log.times" # the second line is for ended children: user and system time, as 1m2.30s
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
    cat "$log.said" # in one piece, so that the lines of two programs do not mix
    echo "$ok $bad $skipped $name $cpu" >"$log.count"
    sed -n "s!^# fault \(.*\)!\1 \`sh tests/run.sh build $name\` |!p" "$log" >"$log.faults"
    cd "$top" && rm -rf "${HOODOO_SCRATCH:?}/$name"
    exit 0
fi

build=$(realpath "$1")
shift
export HOODOO="$build/hoodoo" HOODOO_LIBEXEC="$build" HOODOO_TOP="$top" CMOCKA_MESSAGE_OUTPUT=tap
[ -x "$build/hoodoo-read" ] || HOODOO_LIBEXEC=$top/build # sanitizer builds have no readers
export PYTHONPATH="$top/tests/lib" PYTHONDONTWRITEBYTECODE=1
HOODOO_SCRATCH=$(mktemp -d "${TMPDIR:-/tmp}/hoodoo-test.XXXXXX")
export HOODOO_SCRATCH
export MESA_SHADER_CACHE_DIR="$HOODOO_SCRATCH/shaders" # tests share compiled kernels, but not those of earlier runs
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
# Removes the programs listed in the file $HOODOO_TEST_BUT, if it is set.
wanted() {
    if [ -n "${HOODOO_TEST_BUT:-}" ]; then awk -F '\t' 'NR == FNR { but[$1]; next } !($2 in but)' "$HOODOO_TEST_BUT" -; else cat; fi
}
at_once=$(nproc)
# Long programs start first, so that none runs alone at the end.
list "$@" | wanted | awk -F '\t' 'NR == FNR { rank[$1] = NR; next } { print ($2 in rank ? rank[$2] : 1e6) "\t" $0 }' "$top/tests/longest" - |
    sort -s -n -k 1,1 | cut -f 2- | tr '\t' '\n' | xargs -d '\n' -r -n 2 -P "$at_once" sh "$top/tests/run.sh" --one
find "$HOODOO_SCRATCH" -name '*.count' -exec cat {} + >"$HOODOO_SCRATCH/counts"
awk '$3 > 0 { print $4 }' "$HOODOO_SCRATCH/counts" >"$build/skipped"
find "$HOODOO_SCRATCH" -name '*.faults' -exec cat {} + | sort >"$HOODOO_SCRATCH/faults"
sh "$top/tests/faults.sh" "$HOODOO_SCRATCH/faults" >>"$HOODOO_SCRATCH/counts"
echo "most CPU time, in seconds:$(sort -k 5nr "$HOODOO_SCRATCH/counts" | head -n 10 | awk '{ printf " %s %s", $4, $5 }')"
awk '{ passed += $1; failed += $2; skipped += $3 }
    END {
        if (NR == 0) failed = 1
        if (skipped > 0) printf "%d skipped\n", skipped
        printf "%d passed, %d failed\n", passed, failed
        exit failed > 0
    }' "$HOODOO_SCRATCH/counts"

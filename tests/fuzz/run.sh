# run.sh BUILD: runs each target of tests/fuzz for FUZZ_SECONDS (30) under libFuzzer, two at a time, starting from the committed corpus
# and from suitable files of the repository. An input that crashes, hangs, leaks or allocates too much memory is a failure. It stays in
# BUILD/fuzz; add it to tests/fuzz/corpus/TARGET together with the fix. FUZZ_KEEP=1 merges new inputs into the corpus.
# The last line is "N passed, N failed".
set -u
build=$1 seconds=${FUZZ_SECONDS:-30} top=$(pwd) passed=0 failed=0
targets=$(cd tests/fuzz && ls *.c | sed 's/\.c$//')
found=$build/fuzz
rm -rf "$found"
mkdir -p "$found"
work=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# Further initial inputs.
seeds() {
    case $1 in
    job) ls "$top"/jobs/*.yaml "$top"/tests/formats/*/*/*.yaml ;;
    manifest) ls "$top"/tests/formats/*/*/frames/*.json ;;
    checkpoint) ls "$top"/tests/formats/*/*/checkpoint/*.ckpt ;;
    stacks) ls "$top"/tests/formats/*/*/stacks/*.stacks ;;
    esac
}

fuzz() {
    mkdir -p "$found/new/$1" "$found/seed/$1" "$top/tests/fuzz/corpus/$1"
    for f in $(seeds "$1"); do cp "$f" "$found/seed/$1"; done
    set -- "$1" -rss_limit_mb=2048 -timeout=60 -max_len=65536 "-artifact_prefix=$found/$1-" "-dict=$top/tests/fuzz/words.dict"
    LSAN_OPTIONS=suppressions=$top/tests/fuzz/lsan.supp:print_suppressions=0 FUZZ_FOLDER=$work "$build/tests/fuzz/$1" "${@:2}" "-max_total_time=$seconds" -print_final_stats=1 \
        "$found/new/$1" "$found/seed/$1" "$top/tests/fuzz/corpus/$1" >"$found/$1.log" 2>&1
    echo $? >"$found/$1.rc"
}

set -- $targets
while [ $# -gt 0 ]; do
    fuzz "$1" &
    [ $# -gt 1 ] && fuzz "$2" &
    wait
    shift; [ $# -gt 0 ] && shift
done
for t in $targets; do
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$found/$t.log")
    if [ "$(cat "$found/$t.rc")" = 0 ]; then
        passed=$((passed + 1))
        echo "$t: ${runs:-0} inputs"
    else
        failed=$((failed + 1))
        echo "$t: FAILED"
        tail -40 "$found/$t.log"
        ls "$found/$t"-* 2>/dev/null
    fi
    if [ "${FUZZ_KEEP:-}" ] && [ "$(cat "$found/$t.rc")" = 0 ]; then
        "$build/tests/fuzz/$t" -merge=1 "$top/tests/fuzz/corpus/$t" "$found/new/$t" >/dev/null 2>&1
    fi
done
echo "$passed passed, $failed failed"
[ $failed = 0 ]

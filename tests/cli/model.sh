#!/bin/sh
# A fourth model needs one file and one row. Both are added to a copy of the sources; the resulting program plans, runs, resumes,
# draws and reports the model. Only files that expand JOB_MODELS are compiled again.
set -u
build=$(dirname "$HOODOO")
say() {
    [ "$1" = 0 ] && echo "ok - $2" || echo "not ok - $2"
}
show() {
    make -s --no-print-directory -C "$HOODOO_TOP" --eval="show:;@echo \$($1)" show 2>/dev/null
}
tree=$PWD/tree
mkdir -p "$tree/job"
sed 's/^    MODEL(GOBLINS, /    MODEL(MELT, melt, .samples = "lumps")   \\\n&/' "$HOODOO_TOP/src/job/keys.def" >"$tree/job/keys.def"
cd "$HOODOO_TOP" || exit 1
made=0
for f in $(git grep -l 'JOB_MODELS(' -- 'src/*.c' 2>/dev/null || grep -rl 'JOB_MODELS(' src --include='*.c') src/job/table.c tests/cli/model/melt.c; do
    # shellcheck disable=SC2046 # lists of flags
    $(show CC) -I"$tree" $(show CPPFLAGS) $(show CFLAGS) $(show EXR_FLAGS) -Werror -c -o "$tree/$(basename "$f" .c).o" "$f" || made=1
done
# shellcheck disable=SC2046
$(show CC) $(show CFLAGS) -o "$tree/hoodoo" "$build/src/main.o" "$tree"/*.o "$build/libhoodoo.a" $(show LDLIBS) || made=1
cd "$OLDPWD" || exit 1
say $made "a file and a row make a program with a fourth model"

cat >job.yaml <<'JOB'
hoodoo: 1
name: ice
model: melt
frames: 1-4
clock: {years_per_frame: 100}
domain: {size_m: [4, 4, 4], spacing_m: 0.25}
scene: {sphere: {center_m: [2, 2, 0], radius_m: 1.8}}
cameras: {main: {orbit: {target_m: [2, 2, 1], distance_m: 9}, resolution: [64, 64]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 2}
JOB
new=$tree/hoodoo
for verb in "plan job.yaml" "run job.yaml --out whole --progress none" \
    "run job.yaml --out pieces --frames 1-2 --progress none" "run job.yaml --out pieces --progress none" \
    "verify pieces" "mesh whole" "preview whole --resolution 96x54" "report whole"; do
    # shellcheck disable=SC2086
    "$new" $verb >log 2>&1
    code=$?
    [ $code = 0 ] || cat log
    say $code "$verb"
done
for folder in points volumes aov frames; do
    diff -r whole/$folder pieces/$folder
    say $? "continued from a checkpoint, $folder has the same bytes"
done
grep -q 'Lumps' whole/report/index.html
say $? "the report says what its rock is counted in"
"$new" run job.yaml --out no --set clock.years_per_frame=0 --set clock.seconds_per_frame=0.1 >log 2>&1
[ $? = 2 ] && grep -q 'model: melt does not support shots in real time' log
say $? "and what it cannot do is refused"
"$HOODOO" plan job.yaml >log 2>&1
[ $? = 2 ] && grep -q 'melt' log
say $? "which the program without it does not know"

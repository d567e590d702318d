#!/bin/sh
# Water in two runs, with a checkpoint in between, gives byte for byte the frames of one run.
set -u
cat >job.yaml <<'JOB'
hoodoo: 1
name: brook
frames: 1-7
clock: {years_per_frame: 200}
domain: {size_m: [14, 12, 9], spacing_m: 0.5}
scene: {union: [plane: {point_m: [7, 6, 4], normal: [-0.3, 0.1, 1]}, box: {min_m: [9, 2, 3], max_m: [12, 10, 8]}]}
strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.002}]
rain: {m_per_yr: {1: 0.5, 5: 0.9}, erosion: 20, threshold_Pa: 0.05, leak: true}
sources: [{path_m: [[11, 6, 8.2]], m3_per_yr: 200}]
cameras: {main: {orbit: {target_m: [7, 6, 4], distance_m: 20}, resolution: [64, 64]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 3}
JOB
say() {
    [ "$1" = 0 ] && echo "ok - $2" || echo "not ok - $2"
}
"$HOODOO" run job.yaml --out whole --progress none >log 2>&1
say $? "in one run"
LP_NUM_THREADS=1 "$HOODOO" run job.yaml --out again --progress none >>log 2>&1
say $? "once more, with another number of threads"
"$HOODOO" run job.yaml --out pieces --frames 1-4 --progress none >>log 2>&1 &&
    "$HOODOO" run job.yaml --out pieces --progress none >>log 2>&1
say $? "in two pieces"
for other in again pieces; do
    for folder in points volumes aov frames; do
        diff -r whole/$folder $other/$folder >>log 2>&1
        say $? "$other: $folder has the same bytes"
    done
done
cmp -s whole/frames/brook.0001.json whole/frames/brook.0007.json
say $((! $?)) "the rock changes"
"$HOODOO" run job.yaml --out wrong --set 'sources=[{path_m: [[30, 6, 8]], m3_per_yr: 200}]' --progress none >wrong.log 2>&1
[ $? = 2 ] && grep -q 'sources\[0\].path_m: the water enters at 30, 6, 8 m, outside the domain' wrong.log
say $? "a source outside the domain is refused"
grep -q "^not ok" log && cat log
exit 0

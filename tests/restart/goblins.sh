#!/bin/sh
# Goblins in two runs, with a checkpoint in between, give byte for byte the frames of one run.
set -u
cat >job.yaml <<'JOB'
hoodoo: 1
name: goblin
model: goblins
frames: 1-8
clock: {years_per_frame: 300}
domain: {size_m: [4, 4, 5], spacing_m: 0.1}
scene: {cylinder: {from_m: [2, 2, 0], to_m: [2, 2, 4.5], radius_m: 1.5}}
strata:
  - {to_m: 2.5, weak_m_per_kyr: 0.2, bubble: {radius_m: 0.4}}
  - {weak_m_per_kyr: 0.04, bubble: {shape: gumdrop, radius_m: 0.5, offset: [0.2, 0, 0.1]}}
noise: {amplitude: 0.3, scale_m: 1}
goblins: {stress: true, threshold: 0.5}
cameras: {main: {orbit: {target_m: [2, 2, 2], distance_m: 9}, resolution: [64, 64]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 3}
JOB
say() {
    [ "$1" = 0 ] && echo "ok - $2" && return
    echo "not ok - $2"
    tail -n 5 log | sed 's/^/# /'
}
"$HOODOO" run job.yaml --out whole --progress none >log 2>&1
say $? "in one run"
"$HOODOO" run job.yaml --out again --progress none >>log 2>&1
say $? "once more"
"$HOODOO" run job.yaml --out pieces --frames 1-4 --progress none >>log 2>&1 &&
    "$HOODOO" run job.yaml --out pieces --frames 5-6 --progress none >>log 2>&1 &&
    "$HOODOO" run job.yaml --out pieces --progress none >>log 2>&1
say $? "in three pieces"
for other in again pieces; do
    for folder in points volumes aov frames; do
        diff -r whole/$folder $other/$folder >>log 2>&1
        say $? "$other: $folder has the same bytes"
    done
done
"$HOODOO" verify pieces >>log 2>&1
say $? "and verifies"
exit 0

#!/bin/sh
# Rock with crusts and sheeting in two runs gives byte for byte the frames of one run, and particles that are created on demand give the same
# rock as particles that exist from the start. A branch may start to record ages, or stop.
set -u
cat >job.yaml <<'JOB'
hoodoo: 1
name: bare
frames: 1-4
clock: {years_per_frame: 500}
domain: {size_m: [26, 22, 20], spacing_m: 1}
scene: {union: [{box: {min_m: [4, 4, 0], max_m: [22, 18, 6]}}, {box: {min_m: [1, 1, 6], max_m: [25, 21, 19]}}]}
strata: [{to_m: 9, interlock_MPa: 0.6, weak_m_per_kyr: 0.4}, {weak_m_per_kyr: 0.3}]
noise: {amplitude: 0.4, scale_m: 5}
deposition: {viability: 0.5}
sheeting: {per_kyr: 2, thick_m: 0.5, strength_MPa: 0.002}
skin: {crust: 5, crust_kyr: 2, depth_m: 0.7, before_kyr: 2, damp: 2, damp_m: 3}
cameras: {main: {orbit: {target_m: [13, 11, 9], distance_m: 60}, resolution: [64, 48]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 1, keep: 9}
JOB
. "$HOODOO_TOP/tests/restart/lib/pieces.sh"
in_pieces
"$HOODOO" run job.yaml --out all --set domain.particles=all --progress none >>log 2>&1
say $? "with particles everywhere"
same whole all
"$HOODOO" run job.yaml --out none --set skin.crust=1 --set skin.damp=1 --progress none >>log 2>&1
say $? "without"
"$HOODOO" run job.yaml --out begins --from none@2 --progress none >>log 2>&1
say $? "a branch begins to keep ages"
"$HOODOO" run job.yaml --out leaves --from whole@2 --set skin.crust=1 --set skin.damp=1 --progress none >>log 2>&1
say $? "a branch leaves them"
"$HOODOO" inspect leaves/points/bare.0004.vdb >said 2>>log && ! grep -q exposed_kyr said
say $? "and has none"
"$HOODOO" inspect whole/points/bare.0004.vdb >said 2>>log && grep -q exposed_kyr said
say $? "points have them"
"$HOODOO" inspect whole/volumes/bare.0004.vdb >said 2>>log && grep -q exposed_kyr said
say $? "volumes have them"
"$HOODOO" inspect whole/aov/bare.0004.exr >said 2>>log && grep -q exposed.kyr said
say $? "pictures have them"
! "$HOODOO" inspect none/aov/bare.0004.exr 2>>log | grep -q exposed
say $? "and only where they are kept"
# Rock that water exposes and covers within one frame is inside again at its end; a run must be able to continue from its age.
cat >covered.yaml <<'JOB'
hoodoo: 1
name: covered
frames: 1-4
clock: {years_per_frame: 900}
seed: 3
domain: {size_m: [16, 10, 12], spacing_m: 0.5}
scene: {union: [{box: {min_m: [1, 1, 0], max_m: [15, 9, 1.5]}}, {box: {min_m: [2, 2, 4], max_m: [14, 8, 10]}}, {box: {min_m: [2, 2, 1], max_m: [5, 8, 5], inert: true}}, {box: {min_m: [11, 2, 1], max_m: [14, 8, 5], inert: true}}]}
strata: [{to_m: 6, weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}, {weak_m_per_kyr: 0.05, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}]
noise: {amplitude: 0.4, scale_m: 4}
wind: {direction: [0.8, 0.6, 0], speed_m_s: 9, abrasion: 0.55}
rain: {m_per_yr: 0.4, erosion: 2, threshold_Pa: 0.1}
deposition: {viability: 0.3, repose_deg: 34}
skin: {exposed: true}
checkpoint: {every: 1, keep: 9}
JOB
"$HOODOO" run covered.yaml --out covered --progress none >>log 2>&1
say $? "rock that deposits cover"
for frame in 2 3; do
    sed "s/name: covered/name: goes_on/" covered.yaml >goes_on.yaml
    "$HOODOO" run goes_on.yaml --out "on$frame" --from "covered@$frame" --progress none >>log 2>&1
    say $? "continues from frame $frame"
done
exit 0

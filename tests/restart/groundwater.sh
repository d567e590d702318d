#!/bin/sh
# Groundwater in two runs gives byte for byte the frames of one run, and particles that are created on demand give the same rock as
# particles that exist from the start. Edits switch groundwater on and off.
set -u
cat >job.yaml <<'JOB'
hoodoo: 1
name: seep
frames: 1-4
clock: {years_per_frame: 500}
domain: {size_m: [26, 20, 20], spacing_m: 1, sides: {x_min: wall}}
scene: {union: [{box: {min_m: [-1, -1, 0], max_m: [24, 21, 5]}}, {box: {min_m: [-1, 1, 5], max_m: [19, 19, 19]}}]}
strata: [{to_m: 5, conductivity_m_per_yr: 0.001}, {interlock_MPa: 0.2, weak_m_per_kyr: 0.4}]
attitude: {dip_deg: 4, dip_azimuth_deg: 20}
groundwater: {recharge_m_per_yr: 0.04, sapping: 4, weakening: 0.4}
deposition: {viability: 0.5}
cameras: {main: {orbit: {target_m: [13, 11, 9], distance_m: 60}, resolution: [64, 48]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 1, keep: 9}
JOB
. "$HOODOO_TOP/tests/restart/lib/pieces.sh"
in_pieces
"$HOODOO" run job.yaml --out all --set domain.particles=all --progress none >>log 2>&1
say $? "with particles everywhere"
same whole all
"$HOODOO" run job.yaml --out none --set groundwater.recharge_m_per_yr=0 --progress none >>log 2>&1
say $? "without"
! "$HOODOO" inspect none/aov/seep.0004.exr 2>>log | grep -q seepage
say $? "and its pictures have no seepage"
cat job.yaml - >edits.yaml <<'JOB'
edits: [{frame: 2, set: {groundwater.recharge_m_per_yr: 0}}, {frame: 4, set: {groundwater.recharge_m_per_yr: 0.03}}]
JOB
"$HOODOO" run edits.yaml --out edited --progress none >>log 2>&1
say $? "edits end and begin it"
"$HOODOO" run edits.yaml --out edited_pieces --frames 1-3 --progress none >>log 2>&1 &&
    "$HOODOO" run edits.yaml --out edited_pieces --progress none >>log 2>&1
say $? "in two pieces, too"
same edited edited_pieces
for kind in points/seep.0004.vdb volumes/seep.0004.vdb aov/seep.0004.exr; do
    "$HOODOO" inspect "whole/$kind" >said 2>>log && grep -q seepage said
    say $? "seepage is in $kind"
done
exit 0

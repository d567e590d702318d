#!/bin/sh
# Rock with beds, a fault and joints in two runs gives byte for byte the frames of one run, and particles that are created on demand give the
# same rock as particles that exist from the start.
set -u
cat >job.yaml <<'JOB'
hoodoo: 1
name: built
frames: 1-4
clock: {years_per_frame: 400}
domain: {size_m: [26, 22, 20], spacing_m: 1}
scene: {box: {min_m: [1, 1, 0], max_m: [25, 21, 19]}}
strata: [{to_m: 9, interlock_MPa: 0.6}, {weak_m_per_kyr: 0.1}]
attitude: {dip_deg: 12, dip_azimuth_deg: 30, folds: [{wavelength_m: 20, amplitude_m: 2}], faults: [{point_m: [16, 16, 8], throw_m: 3, strike_deg: 80, breccia_m: 1}]}
strata_from: [{thickness_m: 0.4, parting_m: 0.02, markers: [{at_m: 14, thickness_m: 0.5}], cross: {set_m: 3}}]
joints: [{strike_deg: 20, spacing_m: 6, persistence: 0.7}, {strike_deg: 110, spacing_m: 5, dip_deg: 80, jitter_deg: 5}]
concretions: [{per_m3: 0.02, radius_m: 1.2, flatten: 2}]
output: {aov: {cameras: []}}
checkpoint: {every: 1}
JOB
. "$HOODOO_TOP/tests/restart/lib/pieces.sh"
in_pieces
bare="--set joints.0.blocks=false --set joints.1.blocks=false"
# shellcheck disable=SC2086 # a list of options
"$HOODOO" run job.yaml --out needed $bare --progress none >>log 2>&1 &&
    "$HOODOO" run job.yaml --out all $bare --set domain.particles=all --progress none >>log 2>&1
say $? "with particles where the weather is, and everywhere"
same needed all
cmp -s whole/points/built.0004.vdb needed/points/built.0004.vdb
[ $? = 1 ]
say $? "joints that part blocks are another job"
exit 0

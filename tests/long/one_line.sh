#!/bin/sh
# A value is one line. A copy of the tree gets one more: rate_factor, a field that particles carry and no file has ever held. (That
# points hold it is the field's own line.) It must be in every place where values are, with nothing else changed.
set -u
. "$HOODOO_TOP/tests/long/lib/tree.sh"
has() { # what, pattern, file
    grep -aqE -- "$2" "$3"
    say $? "$1"
}
sed -i 's/^FIELD(rate_factor, float, 1, STATE, "",/FIELD(rate_factor, float, 1, STATE, "rate_factor",/' tree/src/particles/particles.def
sed -i '/^VALUE(id,/i VALUE(rate_factor, "", "f", OF_FIELD(rate_factor), FROM_SKIN, KIND_SCALAR, HAS_ALWAYS, EVERYWHERE, BITS_HALF, "rate_factor", CHANNELS("rate_factor.Y"), LEGEND("", 1, AXIS_LINEAR, SPAN(0, 2), "", ""), "how its rates differ")' tree/src/job/values.def
[ "$(cat tree/src/particles/particles.def tree/src/job/values.def | grep -c '"rate_factor"')" = 2 ] || echo "not ok the two lines are there"
build_tree value

cat >block.yaml <<'J'
hoodoo: 1
name: block
frames: 1-2
clock: {years_per_frame: 2000}
domain: {size_m: [12, 10, 10], spacing_m: 1}
scene: {box: {min_m: [3, 3, 0], max_m: [9, 7, 8]}}
strata: [{weak_m_per_kyr: 0.1, interlock_MPa: 0.1}]
noise: {amplitude: 0.3, scale_m: 3}
cameras: {main: {orbit: {target_m: [6, 5, 4], distance_m: 30}, resolution: [64, 48]}}
output: {vdb: {precision: 16bit}, aov: {cameras: [main]}}
farm: {show: [rate_factor]}
J
"$hoodoo" run block.yaml --out o --progress none >run.log 2>&1 || { tail -3 run.log; echo "not ok it runs"; exit 1; }
"$hoodoo" inspect o/volumes/block.0002.vdb --json >volumes.json
has "volumes have the grid" '"name": *"rate_factor"' volumes.json
"$hoodoo" inspect o/points/block.0002.vdb --json >points.json
has "points have the attribute" 'rate_factor' points.json
"$hoodoo" inspect o/aov/block.0002.exr --json >aov.json
has "pictures have the channel" 'rate_factor\.Y' aov.json
has "USD's points have the primvar" 'primvars:rate_factor' "$(ls o/points/*.0002.usdc)"
has "USD's clips declare it" 'primvars:rate_factor' o/points/block.clips.usda
has "the stage has the field" 'rate_factor' o/block.usda
"$hoodoo" mesh o >mesh.log 2>&1
has "meshes have it at the vertices" '^property float rate_factor' o/mesh/block.0002.ply
"$hoodoo" preview -h >help.txt
has "--show knows the word" '--show .*\|rate_factor' help.txt
"$hoodoo" preview o --show rate_factor --preset draft --frames 2 --progress none >preview.log 2>&1
[ -s o/preview/block.rate_factor.0002.png ]
say $? "it is drawn as colours"
"$hoodoo" verify o >verify.log 2>&1
say $? "the files are whole"
/usr/bin/python3 - <<'P'
import OpenImageIO
import numpy as np
f = OpenImageIO.ImageInput.open("o/aov/block.0002.exr")
part = 0
while f.seek_subimage(part, 0):
    if "rate_factor.Y" in f.spec().channelnames:
        p = f.read_image(part, 0, 0, 1, OpenImageIO.FLOAT)
        r = p[p > 0]
        good = r.size > 50 and r.std() > 1e-3 and 0.2 < r.mean() < 5
        print("ok" if good else "not ok", "pixels have the particles' values:", r.size, r.min(), r.max())
    part += 1
P

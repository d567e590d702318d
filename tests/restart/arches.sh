#!/bin/sh
# Arches in blocks: frames of several runs, interrupted during slides, are byte for byte those of one run, and the
# ledger balances. A terrain can be the scene of an Arenite job, where its loose material becomes deposits.
set -u
cat >job.yaml <<'JOB'
hoodoo: 1
name: terrain
model: arches
frames: 1-8
domain: {size_m: [16, 12, 10], spacing_m: 0.5}
scene: {box: {min_m: [0, 0, 0], max_m: [16, 12, 7]}}
arches:
  sweeps: 4
  piles: {rock_m: 0.4, rocks: 20}
  maps: true
  materials: {gravel: {repose_deg: 38, color: [0.2, 0.2, 0.25]}}
  operations:
    - {tool: noise, frames: 1, strength: 0.8, scale_m: 4}
    - {tool: sweep, frames: 1-4, points_m: [[-1, 6, 4, 2], [8, 5, 4, 2.5], [17, 7, 4, 2]], roughness: 0.2}
    - {tool: erode, frames: 2-6, points_m: [[4, 6, 6, 2], [11, 6, 6, 2]], rocks: 0.7}
    - {tool: deposit, frames: 3, material: gravel, points_m: [[8, 6, 9, 3]], thickness_m: 2}
    - {tool: fill, frames: 5, points_m: [[8, 6, 4, 1]], level_m: 2.5}
cameras: {main: {orbit: {target_m: [8, 6, 4], distance_m: 30}, resolution: [64, 64]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 3}
JOB
say() {
    [ "$1" = 0 ] && echo "ok - $2" || echo "not ok - $2"
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
    for folder in points volumes rocks stacks aov frames; do
        diff -r whole/$folder $other/$folder >>log 2>&1
        say $? "$other: $folder has the same bytes"
    done
done
"$HOODOO" verify pieces >>log 2>&1
say $? "and verifies"
/usr/bin/python3 - <<'PY'
import json, glob
bad = 0
for path in sorted(glob.glob("whole/frames/*.json")):
    l = json.load(open(path))["ledger"]
    bad += l["start"] != l["rock"] + l["deposit"] + l["fallen"] + l["left"]
last = l
print("not ok" if bad else "ok", "- every frame's ledger balances, to the quantum")
print("ok" if last["deposit"] > 0 and last["left"] > 0 else "not ok", "- and something came loose")
PY
cat >further.yaml <<'JOB'
hoodoo: 1
name: further
frames: 1-2
clock: {years_per_frame: 1000}
domain: {size_m: [16, 12, 10], spacing_m: 1}
scene: {stacks: {file: whole/stacks/terrain.0008.stacks}}
deposition: {piles: {rock_m: 0.5, rocks: 20}}
checkpoint: {every: 1}
JOB
"$HOODOO" run further.yaml --out further --progress none >>log 2>&1
say $? "arenite weathers it"
"$HOODOO" run further.yaml --out parts --frames 1 --progress none >>log 2>&1 &&
    "$HOODOO" run further.yaml --out parts --progress none >>log 2>&1 && diff -r further/rocks parts/rocks >>log 2>&1
say $? "in two parts, with the same rocks on its loose ground"
n=$("$HOODOO" inspect --json further/rocks/further.0001.vdb | /usr/bin/python3 -c 'import json, sys; print(sum(g.get("points", 0) for g in json.load(sys.stdin)["grids"]))')
[ "$n" -gt 20 ]
say $? "which are there: $n"
printf 'hoodoo.stck' >broken.stacks
head -c 3000 /dev/urandom >>broken.stacks
sed 's|whole/stacks/terrain.0008.stacks|broken.stacks|' further.yaml >broken.yaml
"$HOODOO" run broken.yaml --out broken --progress none >>log 2>&1
[ $? = 3 ]
say $? "a damaged terrain is refused"
"$HOODOO" mesh further --frames 2 >>log 2>&1 &&
    sed -e 's/name: terrain/name: back/' -e 's/frames: 1-8/frames: 1/' -e '/- {tool/d' -e '/operations:/d' \
        -e 's|scene: .*|scene: {mesh: {file: further/mesh/further.0002.ply, up: y}}|' job.yaml >back.yaml &&
    "$HOODOO" run back.yaml --out back --progress none >>log 2>&1
say $? "and what is left is terrain again"
# Products made from the files of a run: the same pictures, a mesh, a report, a stage.
"$HOODOO" run job.yaml --out bare --set 'output.aov.cameras=[]' --progress none >>log 2>&1 &&
    "$HOODOO" aov bare --camera main --progress none >>log 2>&1
say $? "pictures out of the files"
same=0
for frame in 1 4 8; do
    cmp -s whole/aov/terrain.main.000$frame.exr bare/aov/terrain.main.000$frame.exr || same=1
done
say $same "are the run's own, byte for byte"
cmp -s whole/terrain.usda pieces/terrain.usda && cmp -s whole/rocks/terrain.shapes.usda pieces/rocks/terrain.shapes.usda
say $? "the stage of the pieces is that of the whole"
"$HOODOO" mesh whole --frames 8 >>log 2>&1 && [ -s whole/mesh/terrain.0008.ply ]
say $? "a mesh"
"$HOODOO" report whole --out page >>log 2>&1 || "$HOODOO" report whole >>log 2>&1
[ -s whole/report/index.html ] && grep -q "terrain" whole/report/index.html
say $? "a report"
# A branch with another tool from a frame on; another domain is refused.
sed 's/  - {tool: fill.*/&\n    - {tool: sweep, frames: 8, points_m: [[8, -1, 5, 2], [8, 13, 5, 2]]}/; s/name: terrain/name: other/' job.yaml >other.yaml
"$HOODOO" run other.yaml --from whole@7 --out branch --progress none >>log 2>&1 && [ -s branch/frames/other.0008.json ] && [ ! -e branch/frames/other.0006.json ]
say $? "a branch with a further tool"
cmp -s whole/stacks/terrain.0008.stacks branch/stacks/other.0008.stacks
[ $? = 1 ]
say $? "is other terrain"
sed 's/size_m: \[16, 12, 10\]/size_m: [16, 12, 11]/' other.yaml >taller.yaml
"$HOODOO" run taller.yaml --from whole@7 --out taller --progress none >>log 2>&1
[ $? = 7 ]
say $? "a branch of another height is refused"
# Images: a heightfield as scene, a cover, and the map that shows them.
/usr/bin/python3 - <<'PY'
import numpy as np, OpenImageIO as oiio
y, x = np.mgrid[0:24, 0:32]
for name, value in (("height", 0.5 + 0.1 * np.sin(x / 6) * np.cos(y / 5)), ("sand", 0.5 - 0.5 * np.cos(x / 5) * np.cos(y / 4))):
    out = oiio.ImageOutput.create(name + ".exr")
    out.open(name + ".exr", oiio.ImageSpec(32, 24, 1, oiio.FLOAT))
    out.write_image(value.astype(np.float32).reshape(24, 32, 1))
    out.close()
PY
cat >image.yaml <<'JOB'
hoodoo: 1
name: image
model: arches
frames: 1
domain: {size_m: [16, 12, 10], spacing_m: 0.5}
scene: {heightfield: {file: height.exr, min_m: [0, 0, 0], max_m: [16, 12, 8]}}
arches: {maps: true, stacks: none, covers: [{file: sand.exr, material: sand, thickness_m: 1}]}
JOB
"$HOODOO" run image.yaml --out image --progress none >>log 2>&1
say $? "terrain from images"
/usr/bin/python3 - <<'PY'
import numpy as np, OpenImageIO as oiio
def read(path):
    file = oiio.ImageInput.open(path)
    names = file.spec().channelnames
    return dict(zip(names, np.moveaxis(file.read_image(0, 0, 0, len(names), oiio.FLOAT), 2, 0)))
map_, sand, height = read("image/aov/image.0001.exr"), next(iter(read("sand.exr").values())), next(iter(read("height.exr").values()))
print("#", *map_)
total = map_["bedrock.thickness"] + map_["sand.thickness"]
good = np.allclose(map_["sand.thickness"], sand, atol=1e-5) and np.allclose(map_["height.Z"], total, atol=1e-5)
print("ok" if good else "not ok", "- the map has the cover's thickness, and heights add up", abs(map_["sand.thickness"] - sand).max())
worst = abs(map_["bedrock.thickness"] - 8 * height).max()
print("ok" if worst < 0.05 else "not ok", "- bedrock is as high as the height field says, within", worst)
PY
grep -q "^not ok" log && cat log
exit 0

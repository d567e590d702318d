"""The shape voxels: a goblin as the scene of another job, of goblins and of arenite; and files that are not of this kind."""

import glob
import json
import os

from script import finish, hoodoo, ok

JOB = """hoodoo: 1
name: NAME
model: MODEL
frames: 1-LAST
clock: {years_per_frame: 400}
domain: {size_m: [4, 4, 5], spacing_m: SPACING}
scene: SCENE
strata: [{weak_m_per_kyr: 0.3, bubble: {radius_m: 1}}]
"""
BLOCK = "{cylinder: {from_m: [2, 2, 0], to_m: [2, 2, 4.3], radius_m: 1.7}}"


def run(name, model, last, spacing, scene, *sets):
    text = JOB
    for old, new in (("NAME", name), ("MODEL", model), ("LAST", last), ("SPACING", spacing), ("SCENE", scene)):
        text = text.replace(old, str(new))
    with open(f"{name}.yaml", "w") as file:
        file.write(text)
    return hoodoo("run", f"{name}.yaml", "--out", name, "--progress", "none", *(word for s in sets for word in ("--set", s)))


def frame(name, number):
    with open(f"{name}/frames/{name}.{number:04d}.json") as file:
        return json.load(file)


def content(path):
    with open(path, "rb") as file:
        return file.read()


code, said = run("first", "goblins", 4, 0.25, BLOCK, "goblins.voxels=last")
path = "first/voxels/first.0004.voxels"
ok(code == 0 and glob.glob("first/voxels/*") == [path] and any(f["path"] == "voxels/first.0004.voxels" for f in frame("first", 4)["files"]),
   "goblins write the voxels of their last frame, which is in the manifest", said)
code, said = hoodoo("verify", "first")
ok(code == 0, "verify reads it", said)
scene = f"{{voxels: {{file: {path}}}}}"
code, said = run("second", "goblins", 1, 0.25, scene, "goblins.voxels=all")
ok(code == 0 and content("second/voxels/second.0001.voxels") == content(path), "goblins that begin with it have the same voxels, each to a 64th", said)
rock = frame("second", 1)["statistics"]["volume_m3"]
ok(abs(rock - frame("first", 4)["statistics"]["volume_m3"]) < 0.002 * rock, "which are those of the frame", rock, frame("first", 4)["statistics"])
code, said = run("third", "arenite", 1, 0.25, scene)
found = frame("third", 1)
ok(code == 0 and abs(found["statistics"]["volume_m3"] - rock) < 1e-4 * rock and found["ledger"]["start"] == frame("second", 1)["ledger"]["start"],
   "arenite has a particle for each voxel, with its share", said, found, rock)
code, said = run("fine", "arenite", 1, 0.125, scene)
ok(code == 0 and abs(frame("fine", 1)["statistics"]["volume_m3"] - rock) < 0.01 * rock, "at half the spacing it is the same rock", said)
code, said = run("up", "arenite", 1, 0.25, f"{{voxels: {{file: {path}, translate_m: [0, 0, 0.5]}}}}")
ok(code == 2 and "z = 0.5 m" in said, "in the air it is refused", code, said)
os.remove(path)
with open("bad.voxels", "wb") as file:
    file.write(b"hoodoo.stck" + bytes(100))
code, said = run("bad", "arenite", 1, 0.25, "{voxels: {file: bad.voxels}}")
ok(code == 3 and "bad.voxels: not a .voxels file" in said, "another file is refused", code, said)
with open("bad.voxels", "wb") as file:
    file.write(content("second/voxels/second.0001.voxels")[:-9])
code, said = run("bad", "arenite", 1, 0.25, "{voxels: {file: bad.voxels}}")
ok(code == 3 and "bad.voxels: damaged" in said, "and a shortened one", code, said)
code, said = run("bad", "arenite", 1, 0.25, scene)
ok(code == 3 and path in said, "and a missing one", code, said)
finish()

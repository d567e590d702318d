"""OpenVDB files as shapes: hoodoo's own volumes give the same rock, level sets and fogs of other programs give theirs, and other files are
refused."""
import json
import math
import os
import subprocess

import numpy as np
import pyopenvdb

HOODOO = os.environ["HOODOO"]
JOB = """hoodoo: 1
name: {name}
frames: 1-1
clock: {{years_per_frame: 1}}
domain: {{size_m: [14, 14, 12], spacing_m: 0.25}}
scene: {scene}
collapse: {{blocks: vanish}}
stress: {{max_iterations: 1}}
"""


def check(good, what, *notes):
    print("ok" if good else "not ok", what, *notes, flush=True)


def run(name, scene):
    """The volume of rock in m3, or the error message."""
    with open(f"{name}.yaml", "w") as f:
        f.write(JOB.format(name=name, scene=scene))
    said = subprocess.run([HOODOO, "run", f"{name}.yaml", "--out", name, "--progress", "none"], capture_output=True, text=True)
    if said.returncode:
        return said.stderr
    with open(f"{name}/frames/{name}.0001.json") as f:
        return json.load(f)["statistics"]["volume_m3"]


def near(value, wanted, share=0.005):
    return isinstance(value, float | int) and abs(value / wanted - 1) <= share


SHAPE = "{sphere: {center_m: [7, 7, 4], radius_m: 6}}"
first = run("first", SHAPE)
check(isinstance(first, float | int), "a first run", first)
volume = run("again", "{volume: {file: first/volumes/first.0001.vdb}}")
check(near(volume, first), "its volumes are its rock again", volume, first)


def density(name):
    """The share of rock at each sample, an array."""
    grid, out = pyopenvdb.read(f"{name}/volumes/{name}.0001.vdb", "density"), np.zeros((50, 50, 50))
    grid.copyToArray(out, ijk=(-5, -5, -45))
    return out


# Flat faces, edges, a ball of six spacings and, at a wall, rock that goes on: where the smoothed surface is a few percent too small.
COARSE = "{union: [{box: {min_m: [%s, 1.1, 0], max_m: [5.4, 9.4, 5.3]}}, {sphere: {center_m: [9.4, 8, 2.9], radius_m: 3.1}}]}"
for wall in (False, True):
    job, JOB = JOB, JOB.replace("spacing_m: 0.25", "spacing_m: 0.5" + (", sides: {{x_min: wall}}" if wall else ""))
    name, again = ("walled", "walled_loop") if wall else ("coarse", "loop")
    coarse = run(name, COARSE % (-1 if wall else 0.7))
    volume = run(again, "{volume: {file: %s/volumes/%s.0001.vdb}}" % (name, name))
    one, two = density(name), density(again)
    same = np.minimum(one, two).sum() / np.maximum(one, two).sum()
    check(near(volume, coarse, 0.005 if wall else 0.002) and same > (0.995 if wall else 0.997), f"box and ball at half a metre{' and a wall' if wall else ''} come back", volume, coarse, same)
    if not wall:
        volume = run("turned", "{volume: {file: coarse/volumes/coarse.0001.vdb, scale: [0.9, 0.9, 0.9], rotate_deg: [0, 0, 20], translate_m: [3, 0, 0]}}")
        check(near(volume, coarse * 0.9 ** 3), "scaled and turned", volume, coarse * 0.9 ** 3)
        volume = run("smooth", "{volume: {file: coarse/volumes/coarse.0001.vdb, grid: surface}}")
        check(near(volume, coarse, 0.06) and not near(volume, coarse, 0.02), "the grid 'surface' alone is smoother and smaller", volume, coarse)
    JOB = job

ball = 4 / 3 * math.pi * 27
level = pyopenvdb.createLevelSetSphere(radius=3, center=(6, 6, 3), voxelSize=0.2)
level.name = "ball"
fog = pyopenvdb.FloatGrid()
at = np.indices((60, 60, 60)) * 0.2
fog.copyFromArray(np.clip(0.5 + 3 - np.sqrt((at[0] - 6) ** 2 + (at[1] - 6) ** 2 + (at[2] - 3) ** 2), 0, 1))
fog.transform = pyopenvdb.createLinearTransform(0.2)
fog.gridClass = pyopenvdb.GridClass.FOG_VOLUME
fog.name = "density"
flags = pyopenvdb.BoolGrid()
flags.name = "flags"
pyopenvdb.write("other.vdb", grids=[flags, fog, level])
for name, more in (("fog", ""), ("level", ", grid: ball")):
    volume = run(name, "{volume: {file: other.vdb%s}}" % more)
    check(near(volume, ball), f"a ball of another program's{more or ', the first grid with floats'}", volume, ball)
volume = run("thin", "{volume: {file: other.vdb, grid: density, density: 0.9, translate_m: [0, 0, -0.5]}}")
check(near(volume, 4 / 3 * math.pi * 2.6 ** 3, 0.01), "a fog where it is denser", volume)

for name, more, word in (("none", ", grid: cloud", "'ball'"), ("flag", ", grid: flags", "floats"), ("empty", ", grid: density, density: 2", "no surface")):
    said = run(name, "{volume: {file: other.vdb%s}}" % more)
    check(isinstance(said, str) and "other.vdb" in said and word in said, f"refused{more}", str(said)[-300:])
# More than one candidate, and a transform that is neither uniform nor along the axes.
level.name = "level"
fog.name = "fog"
pyopenvdb.write("many.vdb", grids=[level, fog])
with open("many.yaml", "w") as f:
    f.write(JOB.format(name="many", scene="{volume: {file: many.vdb}}"))
said = subprocess.run([HOODOO, "check", "many.yaml"], capture_output=True, text=True).stderr
check("2 grids of floats" in said and "'level'" in said and "volume.grid" in said and "inside out" not in said, "several grids are a warning", said)
turned = pyopenvdb.createLevelSetSphere(radius=15, center=(0, 0, 0), voxelSize=1)
c, s = math.cos(0.5), math.sin(0.5)
turned.transform = pyopenvdb.createLinearTransform([[0.2 * c, 0.2 * s, 0, 0], [-0.1 * s, 0.1 * c, 0, 0], [0, 0, 0.2, 0], [6, 6, 3, 1]])
pyopenvdb.write("turned.vdb", grids=[turned])
volume = run("stretched", "{volume: {file: turned.vdb}}")
check(near(volume, ball / 2, 0.01), "a grid with a transform of its own", volume, ball / 2)
said = subprocess.run([HOODOO, "run", "stretched.yaml", "--out", "told", "--progress", "none"], capture_output=True, text=True).stderr
check(said.count("by its own measure, and") == 1 and "turned.vdb" in said, "a run's log states the volume of each file, once", said)
with open("other.vdb", "rb") as f:
    whole = f.read()
with open("cut.vdb", "wb") as f:
    f.write(whole[: len(whole) // 2])
said = run("cut", "{volume: {file: cut.vdb}}")
check(isinstance(said, str) and "cut.vdb" in said, "and a file that is cut short", str(said)[-300:])

"""Branches at another spacing: `--from` with a half or twice the spacing gives the same rock; interrupted, or after the other run is gone, the
same bytes. run.json says what it was; what cannot be resampled is refused."""

import json
import os
import shutil
import sys

from script import ask, finish, ok, tree

sys.dont_write_bytecode = True
HOODOO = os.environ["HOODOO"]
CHECKPOINT = 7
JOB = """hoodoo: 1
name: rock
frames: 1001-1008
clock: {years_per_frame: 1000}
domain: {size_m: [16, 16, 16], spacing_m: 1}
scene: {union: [box: {min_m: [0, 0, 0], max_m: [16, 16, 2], inert: true}, cylinder: {from_m: [8, 8, 0], to_m: [8, 8, 13], radius_m: 5}]}
strata: [{weak_m_per_kyr: 0.3, strong_m_per_kyr: 0.05, interlock_MPa: 0.2}]
noise: {amplitude: 0.3, scale_m: 4}
wind: {flow: {solver: sph, spacing_m: 4, flushes: 0.3}}
deposition: {viability: 0.5}
checkpoint: {mark: [1004]}
"""


def frames(path):
    """Is it a frame's file?"""
    return path.split("/")[0] in ("points", "volumes", "frames")


def read_json(path):
    with open(path) as file:
        return json.load(file)


def run(out, *options):
    return ask(HOODOO, "run", "rock.yaml", "--out", out, "--progress", "none", *options)


def manifest(out, frame):
    return read_json(os.path.join(out, f"frames/rock.{frame}.json"))


with open("rock.yaml", "w") as file:
    file.write(JOB)
code, said = run("first")
ok(code == 0, "a run at 1 m", said)
half = ("--from", "first@1004", "--set", "domain.spacing_m=0.5")
code, said = run("fine", *half)
ok(code == 0 and "frame 1004: the state of 1 m was resampled at 0.5 m" in said, "goes on at 0.5 m", said)
was, now = manifest("first", 1004), manifest("fine", 1004)
ok(now["years"] == was["years"] == 3000 and abs(now["statistics"]["volume_m3"] / was["statistics"]["volume_m3"] - 1) < 0.005,
   "with its years and its volume", was, now)
ok(read_json("fine/run.json")["from"]["spacing_m"] == 1, "run.json says what the spacing was")
ok("no air of this size" not in said, "its air is kept", said)

code, said = ask(HOODOO, "report", "fine", "--no-pictures")
with open("fine/report/index.html") as file:
    ok(code == 0 and "Frame 1004 is year 3000." in file.read(), "its report counts from the other run's first frame", said)

code, said = run("again", *half, "--frames", "1004-1006")
shutil.rmtree("first/checkpoint")
second, said = run("again", *half)
ok(code == 0 and second == 0 and tree("again", frames) == tree("fine", frames),
   "interrupted, and without the other run's checkpoint: the same bytes", said)
ok(read_json("again/run.json")["from"]["spacing_m"] == 1, "and run.json still says so")
code, said = ask(HOODOO, "verify", "again")
ok(code == 0, "it verifies", said)

code, said = run("coarse", "--from", "fine@1008", "--set", "domain.spacing_m=1", "--set", "frames=1008-1009")
ok(code == 0 and "resampled at 1 m" in said, "back at 1 m", said)
ok(abs(manifest("coarse", 1008)["statistics"]["volume_m3"] / manifest("fine", 1008)["statistics"]["volume_m3"] - 1) < 0.005, "with the same volume")
code, said = run("odd", "--from", "fine@1008", "--set", "domain.spacing_m=0.4")
ok(code == CHECKPOINT and "any whole ratio" in said and not os.path.exists("odd/frames/rock.1008.json"), "0.4 m is refused: 7", code, said)

with open("terrain.yaml", "w") as file:
    file.write("hoodoo: 1\nname: rock\nmodel: arches\nframes: 1-4\ndomain: {size_m: [16, 16, 12], spacing_m: 1}\n"
               "scene: {box: {min_m: [0, 0, 0], max_m: [16, 16, 6]}}\ncheckpoint: {mark: [2]}\n"
               "arches: {operations: [{tool: sweep, frames: 1-4, points_m: [[-1, 8, 4, 2], [17, 8, 4, 2]]}]}\n")
code, said = ask(HOODOO, "run", "terrain.yaml", "--out", "stacks", "--progress", "none")
ok(code == 0, "stacks of 1 m", said)
finer = ("run", "terrain.yaml", "--from", "stacks@2", "--progress", "none", "--set", "domain.spacing_m=0.5")
code, said = ask(HOODOO, *finer, "--out", "other")
ok(code == CHECKPOINT and "set arches.cell_m: 1" in said, "cannot become stacks of 0.5 m: 7", code, said)
code, said = ask(HOODOO, *finer, "--out", "shown", "--set", "arches.cell_m=1")
ok(code == 0, "but they can be shown by voxels of 0.5 m", code, said)
finish()

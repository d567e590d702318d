"""Rock that no weather has come near has no particles: what is written is the same as if it had, whatever happens to it."""

import json
import os
import sys

sys.dont_write_bytecode = True
from script import *

JOB = """hoodoo: 1
name: needed
frames: 1001-1004
clock: {years_per_frame: 1500}
seed: 5
domain: {size_m: [40, 32, 40], spacing_m: 0.75}
scene:
  union:
    - box: {min_m: [6, 4, 12], max_m: [34, 28, 38.2]}
    - cylinder: {from_m: [20, 16, 0], to_m: [20, 16, 14], radius_m: 2.6}
    - cylinder: {from_m: [8, 16, 0], to_m: [8, 16, 6], radius_m: 2}
strata:
  - {to_m: 22, weak_m_per_kyr: 0.3, strong_m_per_kyr: 0.03, interlock_MPa: 0.6}
  - {to_m: 40, weak_m_per_kyr: 0.25, strong_m_per_kyr: 0.02, interlock_MPa: 0.6}
noise: {amplitude: 0.3, scale_m: 8}
paint:
  - {shape: {box: {min_m: [0, 0, 26], max_m: [40, 40, 30]}}, erodibility: 3}
wind: {direction: [0.8, 0.6, 0], speed_m_s: 9, abrasion: 1.2, flow: {solver: uniform}}
cameras:
  main: {orbit: {target_m: [20, 16, 18], distance_m: 90, azimuth_deg: -58, elevation_deg: 9}, resolution: [160, 90]}
output: {up: z, aov: {cameras: [main]}}
checkpoint: {every: 1, keep: 20}
"""
# Deep rock that comes to the surface, breaks off, is painted, and is edited; the last with falls.
CASES = {
    "rain, deposits and plants": ["rain.m_per_yr=0.4", "deposition.viability=0.6", "paint.0.vegetation=1"],
    "a neck that breaks": ["paint.0={shape: {box: {min_m: [0, 0, 4], max_m: [40, 40, 10]}}, erodibility: 30}", "clock.years_per_frame=3000"],
    "an edit, and falls": ["edits=[{frame: 1003, carve: {sphere: {center_m: [20, 16, 36], radius_m: 6}}}]", "collapse.blocks=fall",
                           "deposition.viability=0.6"],
}


def files(root):
    return tree(root, lambda path: path.startswith(("points", "volumes", "aov")))


def facts(root, frame):
    with open(f"{root}/frames/needed.{frame}.json") as file:
        said = json.load(file)
    return {key: said[key] for key in ("ledger", "statistics", "change_m3") if key in said}


def run(root, *sets):
    words = [word for each in sets for word in ("--set", each)]
    return hoodoo("run", "job.yaml", "--out", root, *words)


with open("job.yaml", "w") as file:
    file.write(JOB)
for number, (name, sets) in enumerate(CASES.items()):
    needed, everything = f"needed-{number}", f"all-{number}"
    code, said = run(needed, *sets)
    again, more = run(everything, "domain.particles=all", *sets)
    ok(code == again == 0, f"{name}: both run", said, more)
    ok(len(files(needed)) > 12 and files(needed) == files(everything), f"{name}: the same points, volumes and pictures",
       [path for path, digest in files(needed).items() if files(everything).get(path) != digest])
    ok(all(facts(needed, f) == facts(everything, f) for f in range(1001, 1005)), f"{name}: the same ledger and measures",
       facts(needed, 1004), facts(everything, 1004))
    # A checkpoint has the particles that there are; the first one's are the shell's.
    sizes = [os.path.getsize(f"{root}/checkpoint/needed.1001.ckpt") for root in (needed, everything)]
    ok(sizes[0] < 0.95 * sizes[1], f"{name}: a checkpoint without them is smaller", sizes)
    code, said = hoodoo("run", "job.yaml", "--out", f"blocks-{number}", "--frames", "1001-1002", *[w for s in sets for w in ("--set", s)])
    again, more = run(f"blocks-{number}", *sets)
    ok(code == again == 0 and files(f"blocks-{number}") == files(needed), f"{name}: a resumed run goes on with the same bytes", said, more)

code, said = hoodoo("run", "job.yaml", "--out", "branch", "--from", "needed-0@1003", "--set", "noise.amplitude=0.5", "--set", "frames=1001-1004")
ok(code == 7 and "noise" in said, "a branch whose rock would be another: 7, and why", code, said)
code, said = hoodoo("run", "job.yaml", "--out", "branch2", "--from", "needed-0@1003", "--set", "wind.abrasion=2", "--set", "frames=1001-1004")
ok(code == 0, "a branch in other weather runs", said)
finish()

"""Voxels past number 2^31: a pillar as high as a domain of 2.7 billion voxels, most of which are numbered higher than that, is the same rock,
frame by frame, as in a domain that just holds it."""
import os
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
from script import HOODOO, finish, ok

JOB = """hoodoo: 1
name: pillar
frames: 1-2
clock: {years_per_frame: 1000}
domain: {size_m: SIZE, spacing_m: 1}
scene: {box: {min_m: [4, 4, 0], max_m: [14, 12, 1340]}}
strata: [{weak_m_per_kyr: 0.3}]
wind: {flow: {solver: uniform}}
output: {usd: {points: none}, aov: {cameras: []}}
"""
SIZES = {"tight": "[18, 16, 1400]", "wide": "[1400, 1400, 1400]"}
for name, size in SIZES.items():
    with open(f"{name}.yaml", "w") as file:
        file.write(JOB.replace("SIZE", size))
    done = subprocess.run([HOODOO, "run", f"{name}.yaml", "--out", name, "--progress", "none"], stderr=subprocess.PIPE, text=True)
    ok(done.returncode == 0, f"{name}: {size} voxels", done.stderr)
for frame in (1, 2):
    part = [open(f"{name}/frames/pillar.{frame:04d}.json").read().split('"ledger"')[1].split("}")[0] for name in SIZES]
    ok(part[0] == part[1], f"frame {frame}: the same rock is left", f"{part}")
    points = [open(f"{name}/points/pillar.{frame:04d}.vdb", "rb").read() for name in SIZES]
    # The archives' identities differ, for they are made from the jobs.
    ok(len(points[0]) == len(points[1]) and points[0][57:] == points[1][57:] and len(points[0]) > 100000, f"frame {frame}: the same particles")
for name in SIZES:
    shutil.rmtree(name, ignore_errors=True)
finish()

"""stress.solver: mpm, as a job asks for it, against pcg and against the reference shapes' fields: T in points/*.vdb, in the
interior, two cells or more from edges and faces."""
import csv
import gzip
import json
import os
import subprocess
import sys

import numpy as np
import pyopenvdb as vdb

TOP, HOODOO = os.environ["HOODOO_TOP"], os.environ["HOODOO"]
SHAPES = {
    "column": ([12, 12, 48], [([0, 0, 0], [12, 12, 48])]),
    "ledge": ([32, 16, 32], [([0, 0, 0], [16, 16, 32]), ([16, 0, 22], [32, 16, 32])]),
    "mushroom": ([36, 36, 36], [([13, 13, 0], [23, 23, 24]), ([0, 0, 24], [36, 36, 36])]),
}
SPACING = 1  # m; cells of 2 m
failed = False


def stress_of(name, size, boxes, solver):
    """T by cells of 1 m, as the surface volume has it."""
    out = f"{name}-{solver}"
    job = {"hoodoo": 1, "name": out, "frames": "1-1", "domain": {"size_m": size, "spacing_m": SPACING},
           "scene": {"union": [{"box": {"min_m": low, "max_m": high}} for low, high in boxes]},
           "stress": {"tolerance": 0.003 if solver == "mpm" else 1e-4, "max_iterations": 20000, "solver": solver},
           "output": {"up": "z"}}
    with open(out + ".json", "w") as file:
        json.dump(job, file)
    subprocess.run([HOODOO, "run", out + ".json", "--out", out, "--progress", "none"], check=True, stderr=subprocess.DEVNULL)
    grid = vdb.read(os.path.join(out, "volumes", out + ".0001.vdb"), "stress")
    t = np.zeros(size, np.float32)
    first = grid.transform.worldToIndex((0.5, 0.5, 0.5))
    grid.copyToArray(t, ijk=tuple(round(i) for i in first))
    return t


def inside(rock, cell, depth):
    padded = np.pad(rock, depth)
    low, high = np.array(cell), np.array(cell) + 2 * depth + 1
    return padded[low[0]:high[0], low[1]:high[1], low[2]:high[2]].all()


for name, (size, boxes) in SHAPES.items():
    rock = np.zeros(size, bool)
    for low, high in boxes:
        rock[low[0]:high[0], low[1]:high[1], low[2]:high[2]] = True
    mpm, pcg = stress_of(name, size, boxes, "mpm"), stress_of(name, size, boxes, "pcg")
    p95 = np.percentile(np.abs(pcg[rock]), 95)
    with gzip.open(os.path.join(TOP, "tests/physics/reference", name + ".csv.gz"), "rt") as file:
        exact = {tuple(int(float(row[axis])) for axis in "xyz"): -(float(row["sxx"]) + float(row["syy"]) + float(row["szz"]))
                 for row in csv.DictReader(file)}
    cells = [cell for cell in exact if inside(rock, cell, 4)]
    apart = np.array([abs(mpm[cell] - pcg[cell]) for cell in cells]) / p95
    error = np.array([abs(mpm[cell] - exact[cell]) for cell in cells]) / p95
    ok = len(cells) > 300 and np.percentile(apart, 95) <= 0.05 and np.median(error) <= 0.03 and np.percentile(error, 95) <= 0.08
    failed |= not ok
    print(f"{'ok' if ok else 'not ok'} {name}: at rest, T of material points differs from conjugate gradients' by "
          f"{100 * np.median(apart):.2f} % (median), {100 * np.percentile(apart, 95):.2f} % (95th), from the reference by "
          f"{100 * np.median(error):.2f} %, {100 * np.percentile(error, 95):.2f} % of T_p95 in {len(cells)} cells")
sys.exit(failed)

"""hoodoo mesh: closed, wound outwards, of the rock's volume, in the files' axes, the same in PLY and OBJ."""
import json
import os
import subprocess
import sys

import numpy as np

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True)
    return done.returncode, done.stderr


def read_ply(path):
    raw = open(path, "rb").read()
    end = raw.index(b"end_header\n") + len(b"end_header\n")
    head = raw[:end].decode().split("\n")
    n, m = (int(line.split()[2]) for line in head if line.startswith("element"))
    names = [line.split()[2] for line in head if line.startswith("property float")]
    vertex = np.frombuffer(raw, "<f4", n * len(names), end).reshape(n, len(names))
    face = np.frombuffer(raw, np.dtype([("n", "u1"), ("v", "<u4", 3)]), m, end + vertex.nbytes)
    assert (face["n"] == 3).all() and end + vertex.nbytes + face.nbytes == len(raw)
    return dict(zip(names, vertex.T.astype(float))), face["v"].astype(int)


job = os.path.join(TOP, "tests/restart/twelve.yaml")
for up in "yz":
    code, said = hoodoo("run", job, "--out", up, "--set", f"output.up={up}", "--frames", "1001-1004", "--progress", "none")
    check(code == 0, f"{up} up: the job runs {said if code else ''}")
    code, said = hoodoo("mesh", up, "--frames", "1004")
    check(code == 0 and said == "" and sorted(os.listdir(up + "/mesh")) == ["twelve.1004.obj", "twelve.1004.ply"], f"{up} up: meshed")
    value, face = read_ply(up + "/mesh/twelve.1004.ply")
    at = np.stack([value[axis] for axis in "xyz"], 1)
    edges = np.concatenate([face[:, [0, 1]], face[:, [1, 2]], face[:, [2, 0]]])
    there = {tuple(e) for e in edges}
    check(len(there) == len(edges) and all((b, a) in there for a, b in there), f"{up} up: closed, every edge once each way")
    a, b, c = (at[face[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    expected = json.load(open(up + "/frames/twelve.1004.json"))["statistics"]["volume_m3"]
    # Edges are rounded over a voxel, and this rock is eight voxels thick.
    check(-0.1 < volume / expected - 1 < 0.02, f"{up} up: outwards, holds {volume:.1f} m3 of the rock's {expected:.1f}")
    low, high = at.min(0), at.max(0)
    tall = high[1] if up == "y" else high[2]
    check(tall > 8 and (low[2] < -4 if up == "y" else low[1] > 1), f"{up} up: stands in the right axes, {low} to {high}")
    check(value["stress"].max() > 1e4 and 0 < value["viability"].min() <= value["viability"].max() <= 1, f"{up} up: carries its fields")
    lines = open(up + "/mesh/twelve.1004.obj").read().split("\n")
    obj = np.array([[float(x) for x in line.split()[1:]] for line in lines if line.startswith("v ")])
    check(obj.shape == at.shape and abs(obj - at).max() < 1e-4 and sum(line.startswith("f ") for line in lines) == len(face),
          f"{up} up: the OBJ is the same")
for words, expected, why in ((("mesh", "y", "--frames", "7"), 3, "volumes"), (("mesh", "nowhere"), 3, "nowhere"),
                             (("mesh", "y", "--adaptivity", "2"), 2, "0 to 1")):
    code, said = hoodoo(*words)
    check(code == expected and said.count("\n") == 1 and why in said, f"{' '.join(words)}: {code}")
sys.exit(failed)

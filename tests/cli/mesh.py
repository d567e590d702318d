"""hoodoo mesh: meshes are closed, manifold, oriented outwards and free of self-intersections by CGAL's judgement; their volume equals that of
the level set; PLY and OBJ carry the same values. On frames of every kind, and on fields that are hard to mesh."""
import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pyopenvdb
from scipy import ndimage, spatial

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
CHECKER = os.path.join(os.path.dirname(HOODOO), "tests/ref/mesh_check")
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True)
    return done.returncode, done.stderr


def read_ply(path):
    """The properties of the vertices by name, and the faces; nothing may follow them in the file."""
    kinds = {"float": "<f4", "int": "<i4", "uchar": "u1"}
    raw = open(path, "rb").read()
    end = raw.index(b"end_header\n") + len(b"end_header\n")
    head = [line.split() for line in raw[:end].decode().split("\n")]
    n, m = (int(line[2]) for line in head if line[:1] == ["element"])
    row = np.dtype([(line[2], kinds[line[1]]) for line in head if line[:1] == ["property"] and line[1] != "list"])
    vertex = np.frombuffer(raw, row, n, end)
    face = np.frombuffer(raw, np.dtype([("n", "u1"), ("v", "<i4", 3)]), m, end + vertex.nbytes)
    assert (face["n"] == 3).all() and end + vertex.nbytes + face.nbytes == len(raw)
    return vertex, face["v"].astype(int)


def places(vertex):
    return np.stack([vertex[axis].astype(float) for axis in "xyz"], 1)


def cgal(path, *words):
    done = subprocess.run([CHECKER, path, *words], capture_output=True, text=True)
    return json.loads(done.stdout.replace("nan", "NaN")) if done.returncode == 0 else {"unreadable": done.stderr}


def is_whole(said):
    return all(said.get(k) is True for k in ("manifold", "closed", "valid", "outward")) and said["degenerate"] == said["crossing"] == 0


def level_set(path):
    """The grid `surface` as an array, its voxel size, and the position of its first sample in the world."""
    grid = pyopenvdb.read(path, "surface")
    lo, hi = grid.evalActiveVoxelBoundingBox()
    lo, hi = np.array(lo) - 1, np.array(hi) + 1
    value = np.empty(hi - lo + 1, np.float32)
    grid.copyToArray(value, ijk=tuple(int(c) for c in lo))
    return value, grid.transform.voxelSize()[0], np.array(grid.transform.indexToWorld(tuple(int(c) for c in lo)))


def level_set_volume(path, fine=6):
    """The volume where the trilinear field is negative, by fine^3 samples per voxel."""
    value, voxel, _ = level_set(path)
    n, inside = np.array(value.shape) - 1, 0
    t = (np.arange(fine) + 0.5) / fine
    for x in t:
        a = value[:-1] * (1 - x) + value[1:] * x
        for y in t:
            b = a[:, :-1] * (1 - y) + a[:, 1:] * y
            for z in t:
                inside += np.count_nonzero(b[:, :, :-1] * (1 - z) + b[:, :, 1:] * z < 0)
    return inside * (voxel / fine) ** 3


def meshes(out, frame, name, *words, near=0.01):
    """Meshes one frame and checks the properties of every mesh. Returns vertices and faces. `near`: the tolerance of the volume."""
    code, said = hoodoo("mesh", out, "--frames", str(frame), *words)
    path = f"{out}/mesh/{name}.{frame}.ply"
    if code:
        check(False, f"{out} {' '.join(words)}: {said}")
        sys.exit(1)
    seen, volume = cgal(path), level_set_volume(f"{out}/volumes/{name}.{frame}.vdb")
    vertex, face = read_ply(path)
    check(is_whole(seen), f"{out} {' '.join(words)}: closed, manifold, outwards, nothing crosses: {seen['triangles']} triangles" + ("" if is_whole(seen) else f" {seen}"))
    off = seen["volume"] / volume - 1
    check(abs(off) < near, f"{out} {' '.join(words)}: {100 * off:+.3f} % of the level set's {volume:.1f} m3")
    return vertex, face


# ---- axes, fields and files, for both up axes
job = os.path.join(TOP, "tests/restart/twelve.yaml")
kept = {}
for up in "yz":
    code, said = hoodoo("run", job, "--out", up, "--set", f"output.up={up}", "--frames", "1001-1004", "--progress", "none")
    check(code == 0, f"{up} up: the job runs {said if code else ''}")
    value, face = meshes(up, 1004, "twelve")
    check(sorted(os.listdir(up + "/mesh")) == ["twelve.1004.obj", "twelve.1004.ply", "twelve.1004.usdc", "twelve.clips.usda"],
          f"{up} up: PLY, OBJ, USD and what USD files have")
    at = places(value)
    kept[up] = at, face
    expected = json.load(open(up + "/frames/twelve.1004.json"))["statistics"]["volume_m3"]
    a, b, c = (at[face[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    # Edges are rounded over a voxel, and this rock is eight voxels thick.
    check(-0.1 < volume / expected - 1 < 0.02, f"{up} up: holds {volume:.1f} m3 of the rock's {expected:.1f}")
    low, high = at.min(0), at.max(0)
    tall = high[1] if up == "y" else high[2]
    check(tall > 8 and (low[2] < -4 if up == "y" else low[1] > 1), f"{up} up: stands in the right axes, {low} to {high}")
    check(value["stress"].max() > 1e4 and 0 < value["viability"].min() <= value["viability"].max() <= 1, f"{up} up: carries its fields")
    height = at[:, 1 if up == "y" else 2]
    sure = abs(height - 6) > 0.5
    check((value["layer"][sure] == (height[sure] > 6)).all() and set(value["layer"]) == {0, 1}, f"{up} up: layers end at 6 m")
    colors = {tuple(v[["red", "green", "blue"]]) for v in value}
    # Linear 0.53 0.31 0.18 and 0.42 0.185 0.10 in sRGB.
    check(colors == {(192, 151, 118), (173, 119, 89)} or (print("#", colors) or False), f"{up} up: in the layers' colours")
    obj = [line.split() for line in open(up + "/mesh/twelve.1004.obj")]
    v = np.array([line[1:] for line in obj if line[0] == "v"], float)
    f = np.array([[word.split("//")[0] for word in line[1:]] for line in obj if line[0] == "f"], int)
    check((v[:, :3].astype(np.float32) == at).all() and (f - 1 == face).all(), f"{up} up: the OBJ is the same, to the bit")
    rgb = np.stack([value[c] for c in ("red", "green", "blue")], 1) / 255
    check(abs(v[:, 3:] - rgb).max() < 0.003, f"{up} up: so are its colours")
turned = np.stack([kept["y"][0][:, 0], -kept["y"][0][:, 2], kept["y"][0][:, 1]], 1)
check(turned.shape == kept["z"][0].shape and abs(turned - kept["z"][0]).max() < 1e-6 and (kept["y"][1] == kept["z"][1]).all(),
      "both axes give the same mesh")

shutil.copytree("y", "again")
subprocess.run([HOODOO, "mesh", "again", "--frames", "1004"], env={**os.environ, "OMP_NUM_THREADS": "1"}, check=True)
check(all(open(f"{d}/mesh/twelve.1004.ply", "rb").read() == first for first in [open("y/mesh/twelve.1004.ply", "rb").read()] for d in ["again"]),
      "one thread gives the same bytes")
shutil.rmtree("again/points")
vertex, _ = meshes("again", 1004, "twelve")
height = places(vertex)[:, 1]
check((vertex["layer"] == (height >= 6)).all(), "without points layers go by height")


# ---- a frame of the demo: number and position of triangles, and what smoothing preserves
code, said = hoodoo("run", os.path.join(TOP, "jobs/demo.yaml"), "--out", "demo", "--frames", "1001-1016", "--set", "domain.spacing_m=1",
                    "--set", "clock.years_per_frame=3000", "--set", "wind.flow.solver=uniform", "--progress", "none")
check(code == 0, f"the demo runs {said if code else ''}")
fine, fine_face = meshes("demo", 1016, "demo")
count = len(fine_face)
shutil.copy("demo/mesh/demo.1016.ply", "fine.ply")
for share in (0.03, 0.3, 1):
    vertex, face = meshes("demo", 1016, "demo", "--adaptivity", str(share), near=max(0.01, 0.05 * share))
    off = cgal("demo/mesh/demo.1016.ply", "--from", "fine.ply")["farthest"]
    check(off <= share * 1.0001 and len(face) < count, f"adaptivity {share}: {len(face)} of {len(fine_face)} triangles, none farther off than {off:.4f} m")
    count = len(face)
    # Remaining vertices are vertices of the fine mesh with the same values; all vertices at borders of layers remain.
    same = spatial.cKDTree(places(fine)).query(places(vertex))
    check(same[0].max() == 0 and (fine["layer"][same[1]] == vertex["layer"]).all(), f"adaptivity {share}: vertices stay where they are")
    edges = np.concatenate([fine_face[:, [0, 1]], fine_face[:, [1, 2]], fine_face[:, [2, 0]]])
    border = np.unique(edges[fine["layer"][edges[:, 0]] != fine["layer"][edges[:, 1]]])
    check(len(border) > 100 and np.isin(border, same[1]).all(), f"adaptivity {share}: all {len(border)} vertices at borders of layers stay")


for passes in (3, 30):
    vertex, face = meshes("demo", 1016, "demo", "--smooth", str(passes))
    moved = np.linalg.norm(places(vertex) - places(fine), axis=1)
    check((face == fine_face).all() and 0.1 < moved.max() <= 0.5001, f"{passes} passes: no vertex moves more than {moved.max():.3f} m")
    height = places(vertex)[:, 1] - places(fine)[:, 1]
    drift = abs(height[border])
    check((vertex["layer"] == fine["layer"]).all() and drift.mean() < 0.05, f"{passes} passes: borders of layers move {drift.mean():.3f} m up or down in the mean")
vertex, face = meshes("demo", 1016, "demo", "--smooth", "10", "--adaptivity", "0.1")
check(len(face) < len(fine_face) / 2, "both at once")

# ---- a ledge: a box keeps its edges under smoothing
open("ledge.yaml", "w").write("""hoodoo: 1
name: ledge
frames: 1-1
domain: {size_m: [16, 16, 16], spacing_m: 1}
scene: {union: [box: {min_m: [3, 3, 0], max_m: [13, 13, 6]}, box: {min_m: [5, 5, 6], max_m: [11, 11, 12]}]}
strata: [{to_m: 6}, {to_m: 16}]
""")
code, said = hoodoo("run", "ledge.yaml", "--out", "ledge", "--progress", "none")
check(code == 0, f"a ledge runs {said if code else ''}")
sharp = places(meshes("ledge", "0001", "ledge", near=0.03)[0])
on_top = sharp[:, 1] > 11.9
on_ledge = (abs(sharp[:, 1] - 6) < 0.3) & (np.maximum(abs(sharp[:, 0] - 8), abs(sharp[:, 2] + 8)) > 3.9)
for passes, most in ((10, 0.1), (50, 0.3)):
    even = places(meshes("ledge", "0001", "ledge", "--smooth", str(passes), near=0.03)[0])
    moved = abs(even - sharp)[:, 1]
    check(on_top.sum() > 10 < on_ledge.sum() and moved[on_top | on_ledge].max() < most,
          f"{passes} passes: top and ledge stay, {on_top.sum()} and {on_ledge.sum()} vertices: {moved[on_top].max():.3f} and {moved[on_ledge].max():.3f} m")

# ---- a terrain, its materials and its rocks
open("terrain.yaml", "w").write("""hoodoo: 1
name: terrain
model: arches
frames: 1-4
domain: {size_m: [24, 16, 12], spacing_m: 0.5}
scene: {box: {min_m: [0, 0, 0], max_m: [24, 16, 8]}}
arches:
  piles: {rock_m: 0.5, rocks: 20}
  operations:
    - {tool: noise, frames: 1, strength: 0.8, scale_m: 4}
    - {tool: sweep, frames: 1-2, points_m: [[-1, 8, 4, 2], [12, 7, 4, 2.5], [25, 8, 4, 2]], roughness: 0.2}
    - {tool: erode, frames: 2-3, points_m: [[4, 6, 6, 3], [11, 6, 6, 2]], rocks: 0.7}
    - {tool: deposit, frames: 3, points_m: [[18, 8, 10, 3]], thickness_m: 2}
""")
code, said = hoodoo("run", "terrain.yaml", "--out", "terrain", "--progress", "none")
check(code == 0, f"a terrain runs {said if code else ''}")
vertex, face = meshes("terrain", "0004", "terrain")
shares = {m: vertex[m].astype(float) for m in ("bedrock", "rock", "sand", "water")}
total = sum(shares.values())
check(all(-1e-6 <= s.min() and s.max() <= 1 + 1e-6 for s in shares.values()) and np.median(total) > 0.999, f"shares of materials add up to {np.median(total):.3f}")
loose = vertex["layer"] == 1  # one layer of bedrock, then sand
check(loose.sum() > 50 and shares["sand"][loose].mean() > 0.5 > shares["sand"][vertex["layer"] == 0].mean(), f"{loose.sum()} vertices of sand are of sand")
sandy, bare = shares["sand"] > 0.99, shares["bedrock"] > 0.99
rgb = np.stack([vertex[c].astype(int) for c in ("red", "green", "blue")], 1)
check(abs(rgb[sandy] - [212, 177, 137]).max() <= 2 and abs(rgb[bare] - [192, 151, 118]).max() <= 2, "colours are the materials'")
rocks, rock_face = read_ply("terrain/mesh/terrain.rocks.0004.ply")
seen = cgal("terrain/mesh/terrain.rocks.0004.ply")
said = subprocess.run([HOODOO, "inspect", "terrain/rocks/terrain.0004.vdb", "--json"], capture_output=True, text=True).stdout
n_rocks = json.loads(said)["grids"][0]["points"]
check(all(seen[k] for k in ("manifold", "closed", "valid")) and seen["components"] == n_rocks > 5, f"{n_rocks} rocks, each closed and one piece")
check(0 < seen["volume"] < n_rocks * 4 / 3 * np.pi * 0.8**3, f"of {seen['volume'] / n_rocks:.3f} m3 each")
os.remove("terrain/mesh/terrain.rocks.0004.obj")
hoodoo("mesh", "terrain", "--frames", "4", "--missing")
check(os.path.exists("terrain/mesh/terrain.rocks.0004.obj"), "--missing sees that a rocks' file is missing")
shutil.rmtree("terrain/mesh")
hoodoo("mesh", "terrain", "--frames", "4", "--no-rocks")
check(sorted(os.listdir("terrain/mesh")) == ["terrain.0004.obj", "terrain.0004.ply", "terrain.0004.usdc", "terrain.clips.usda"], "--no-rocks")

def put_field(field):
    """Replaces the volumes of the frame by the grids that a mesh needs."""
    field = np.clip(field, -2.9, 2.9).astype(np.float32)
    for face in (0, -1):
        field[face] = field[:, face] = field[:, :, face] = 3
    grids = []
    for grid in ("surface", "stress", "von_mises", "viability"):
        grids.append(pyopenvdb.FloatGrid(3.0 if grid == "surface" else 0.0))
        grids[-1].name = grid
        grids[-1].copyFromArray(field if grid == "surface" else np.ones_like(field))
    pyopenvdb.write("again/volumes/twelve.1004.vdb", grids)


# ---- fields that are hard to mesh
rng = np.random.default_rng(5)
N = 22
x, y, z = np.mgrid[0:N, 0:N, 0:N].astype(float)
spheres = np.full((N, N, N), 9.0)
for _ in range(40):
    centre, radius = rng.uniform(5, N - 5, 3), rng.uniform(0.8, 3)
    spheres = np.minimum(spheres, np.sqrt((x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2) - radius)
plate = np.maximum(abs(x + 0.7 * y - 0.3 * z - 18) / np.sqrt(1.58) - 0.3, np.sqrt((x - 12) ** 2 + (y - 12) ** 2 + (z - 12) ** 2) - 9)
hard = {
    "spheres that touch": spheres,
    "a plate thinner than a voxel": plate,
    "a chequerboard": np.where((x + y + z) % 2 == 0, -1.0, 1.0),
    "edges that touch": np.where((x // 4 + y // 4) % 2 == 0, -0.5, 0.5),
    "noise": rng.standard_normal((N, N, N)),
    "smooth noise": ndimage.gaussian_filter(rng.standard_normal((N, N, N)), 1.1) * 9,
    "zeros and what is no number": np.where(rng.random((N, N, N)) < 0.02, np.nan, np.round(rng.standard_normal((N, N, N)))),
}
for name, field in hard.items():
    put_field(field)
    for words in ((), ("--adaptivity", "0.05"), ("--adaptivity", "1"), ("--smooth", "20", "--adaptivity", "0.3")):
        code, said = hoodoo("mesh", "again", "--frames", "1004", *words)
        seen = cgal("again/mesh/twelve.1004.ply") if code == 0 else {}
        good = code == 0 and is_whole(seen)
        check(good, f"{name} {' '.join(words)}: {seen.get('triangles')} triangles in {seen.get('components')} pieces" + ("" if good else f" {said} {seen}"))
check(is_whole(cgal("again/mesh/twelve.1004.obj")), "so is an OBJ")

# ---- smoothing removes noise: a ball with noise of 0.15 voxels
noisy = np.sqrt((x - 10.7) ** 2 + (y - 10.4) ** 2 + (z - 10.9) ** 2) - 7.2 + 0.15 * rng.standard_normal((N, N, N))
put_field(noisy)
rough = {}
for passes in (0, 5, 20):
    vertex, face = meshes("again", 1004, "twelve", "--smooth", str(passes))
    r = np.linalg.norm(places(vertex) - [10.7, 10.9, -10.4], axis=1)  # y up
    rough[passes] = r.std()
    print(f"# {passes} passes: {r.mean():.3f} +- {r.std():.3f} voxels from the centre, {cgal('again/mesh/twelve.1004.ply')['volume']:.1f} m3")
check(rough[5] < 0.75 * rough[0] and rough[20] < rough[5], "smoothing takes noise away")

for words, expected, why in ((("mesh", "y", "--frames", "7"), 3, "volumes"), (("mesh", "nowhere"), 3, "nowhere"),
                             (("mesh", "y", "--adaptivity", "2"), 2, "0 to 1"), (("mesh", "y", "--smooth", "-1"), 2, "0 to 100")):
    code, said = hoodoo(*words)
    check(code == expected and said.count("\n") == 1 and why in said, f"{' '.join(words)}: {code}")
sys.exit(failed)

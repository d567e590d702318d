"""Velocities: those of a falling block in points, volumes, meshes and motion vectors, and none for rock at rest. The wind is in a file of its
own, so that it is not taken for the velocity of rock."""
import json
import math
import os
import sys

import numpy as np
import OpenImageIO
import pyopenvdb as vdb

from script import finish, hoodoo, ok

sys.dont_write_bytecode = True
G, FPS = 9.81, 24
# A column stands on the ground, and a block floats.
SHOT = {
    "hoodoo": 1, "name": "shot", "frames": "1001-1004", "fps": FPS, "clock": {"seconds_per_frame": 1 / FPS},
    "domain": {"size_m": [10, 5, 12], "spacing_m": 0.5},
    "scene": {"union": [{"box": {"min_m": [1, 1, 0], "max_m": [3, 4, 6]}}, {"box": {"min_m": [6, 1, 8], "max_m": [9, 4, 11]}}]},
    "cameras": {"main": {"orbit": {"target_m": [7.5, 2.5, 9], "distance_m": 20, "azimuth_deg": 90, "elevation_deg": 0}, "resolution": [96, 96]}},
    "output": {"up": "z", "aov": {"cameras": ["main"]}, "vdb": {"codec": "zip"}, "usd": {"points": "surface"}},
}
YEARS = {
    "hoodoo": 1, "name": "years", "frames": "1001-1002", "clock": {"years_per_frame": 500},
    "domain": {"size_m": [24, 24, 12], "spacing_m": 1}, "scene": {"union": [{"box": {"min_m": [9, 9, 0], "max_m": [15, 15, 8]}}]},
    "strata": [{"weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.1}],
    "wind": {"direction": [1, 0, 0], "speed_m_s": 8, "flow": {"solver": "sph", "spacing_m": 3, "flushes": 0.3}},
    "cameras": {"main": {"orbit": {"target_m": [12, 12, 4], "distance_m": 40}, "resolution": [64, 36]}},
    "output": {"up": "z", "aov": {"cameras": ["main"]}, "vdb": {"codec": "zip"}},
}


def run(job, out, *options):
    with open(job["name"] + ".json", "w") as file:
        json.dump(job, file)
    code, said = hoodoo("run", job["name"] + ".json", "--out", out, "--progress", "none", *options)
    ok(code == 0, f"{out}: runs", said)


def grids(path):
    return {g.name: g for g in vdb.readAllGridMetadata(path)}


def ply(path):
    """Columns by name."""
    with open(path, "rb") as file:
        raw = file.read()
    head, body = raw.split(b"end_header\n", 1)
    kinds = {"float": "<f4", "int": "<i4", "uchar": "u1"}
    lines = head.decode().split("\n")
    n = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    fields = [(line.split()[2], kinds[line.split()[1]]) for line in lines if line.startswith("property") and "list" not in line]
    return np.frombuffer(body, np.dtype(fields), n)


def picture(path):
    image = OpenImageIO.ImageBuf(path)
    found = {}
    for part in range(image.nsubimages):
        buf = OpenImageIO.ImageBuf(path, part, 0)
        pixels = buf.get_pixels(OpenImageIO.FLOAT)
        for i, name in enumerate(buf.spec().channelnames):
            found[name] = pixels[..., i]
    return found


def block(path):
    """Velocities of the voxels of the block, which are at 5 m or higher, and of the column."""
    grid = vdb.read(path, "vel")
    fast, slow = [], []
    for item in grid.citerOnValues():
        x = grid.transform.indexToWorld(item.min)
        (fast if x[0] > 5 else slow).append(item.value)
    return np.array(fast), np.array(slow)


run(SHOT, "shot")
after = 3 / FPS
fast, slow = block("shot/volumes/shot.1004.vdb")
down = -fast[:, 2].mean()
ok(len(fast) > 200 and abs(down / (G * after) - 1) < 0.06, f"volumes: a block that fell for {after:.3f} s falls at {down:.3f} m/s, {G * after:.3f} by g t")
ok(np.abs(fast[:, :2]).max() < 0.05 * down, "volumes: it falls straight", np.abs(fast[:, :2]).max())
ok(len(slow) == 0 or np.abs(slow).max() < 0.15, "volumes: what stands does not move", np.abs(slow).max() if len(slow) else 0)
code, said = hoodoo("mesh", "shot", "--progress", "none")
mesh = ply("shot/mesh/shot.1004.ply")
high = mesh["z"] > 6.5
ok(code == 0 and abs(-mesh["vz"][high].mean() / down - 1) < 0.03 and np.abs(mesh["vz"][mesh["x"] < 4]).max() < 0.15, "meshes: vx vy vz are the block's", said)
bounds = [json.loads(hoodoo("inspect", "--json", f"shot/volumes/shot.{f}.vdb")[1]) for f in (1003, 1004)]
moved = [next(g["bounds_m"]["min"] for g in b["grids"] if g["name"] == "vel") for b in bounds]
ok(math.isclose(moved[0][2] - moved[1][2], 0, abs_tol=1), "volumes: the velocity is where the block is", moved)
usd = open("shot/points/shot.1004.usdc", "rb").read()
ok(b"velocities" in usd and b"vector3f[]" in usd and "velocities" in open("shot/points/shot.clips.usda").read() + open("shot/shot.usda").read(),
   "USD points have velocities")

# A point moved by v / fps is where the motion vector says. The camera looks along y, so the middle of the block moves straight down.
seen = picture("shot/aov/shot.1004.exr")
at = (seen["P.Z"] > 6) & (np.abs(seen["P.X"] - 7.5) < 1)
pixels_per_m = np.polyfit(seen["P.Z"][at], np.arange(96)[:, None].repeat(96, 1)[at], 1)[0]
want, got = -down / FPS * -pixels_per_m, seen["motion.Y"][at].mean()
ok(abs(got / want - 1) < 0.06, f"pictures: motion is {got:.3f} px, and v / fps {want:.3f}")

# In slow motion the film shows a tenth of the speed, and so do the files.
SLOW = {**SHOT, "name": "slow", "clock": {"seconds_per_frame": 0.1 / FPS}}
run(SLOW, "slow")
fast, _ = block("slow/volumes/slow.1004.vdb")
ok(abs(-fast[:, 2].mean() / (0.1 * G * 0.1 * after) - 1) < 0.08, f"slow motion: {-fast[:, 2].mean():.4f} m/s in the film, {0.01 * G * after:.4f} by g t", fast)

run(YEARS, "years")
ok("vel" not in grids("years/volumes/years.1002.vdb") and "wind" not in grids("years/volumes/years.1002.vdb") and not os.path.exists("years/wind"),
   "years: nothing moves, and no wind unless it is asked for")
inside = json.loads(hoodoo("inspect", "--json", "years/volumes/years.1002.vdb")[1])
loose = {g["name"]: g["bounds_m"] for g in inside["grids"] if min(g["bounds_m"]["min"]) < -3 or min(g["bounds_m"]["min"][:2]) < 9 - 5 or max(g["bounds_m"]["max"]) > 15 + 5}
ok(not loose, "years: all grids are within the surface's band of the rock", loose)
code, said = hoodoo("aov", "years", "--set", "cameras.other={orbit: {target_m: [12, 12, 4], distance_m: 30}, resolution: [64, 36]}", "--camera", "other",
                    "--frames", "1002", "--progress", "none")
ok(code == 0 and "wind/" in said and "wind.speed" not in picture("years/aov/years.other.1002.exr"), "aov: a wind that is in no file is no layer, and said", said)

run({**YEARS, "name": "windy"}, "windy", "--set", "output.vdb.wind=true")
wind = vdb.read("windy/wind/windy.1002.vdb", "wind")
speed = [math.hypot(*item.value) for item in wind.citerOnValues()]
ok(set(grids("windy/wind/windy.1002.vdb")) == {"wind"} and 4 < np.median(speed) < 12, f"wind: a file of its own, {np.median(speed):.1f} m/s", grids("windy/wind/windy.1002.vdb").keys())
manifest = json.load(open("windy/frames/windy.1002.json"))
ok(any(f["path"].startswith("wind/") for f in manifest["files"]), "wind: the frame vouches for it")
first = picture("windy/aov/windy.1002.exr")["wind.speed"]
code, said = hoodoo("aov", "windy", "--set", "cameras.other={orbit: {target_m: [12, 12, 4], distance_m: 40}, resolution: [64, 36]}", "--camera", "other",
                    "--frames", "1002", "--progress", "none")
again = picture("windy/aov/windy.other.1002.exr").get("wind.speed")
ok(code == 0 and again is not None and np.array_equal(first, again), "aov: with its file the wind is the run's", said)
finish()

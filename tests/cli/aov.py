"""hoodoo aov: pictures made from the files of a frame equal those of the run, bit for bit; other cameras, layers, samples and mattes."""
import os
import subprocess

import numpy as np
import OpenImageIO

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
JOB = TOP + "/tests/restart/twelve.yaml"


def check(good, what):
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True)
    return done.returncode, done.stderr


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def channels(path):
    """Every channel of every part: {name: array [rows, columns]}."""
    file, out, part = OpenImageIO.ImageInput.open(path), {}, 0
    while file.seek_subimage(part, 0):
        names, ids = file.spec().channelnames, file.spec().format == OpenImageIO.UINT
        value = file.read_image(part, 0, 0, len(names), OpenImageIO.UINT if ids else OpenImageIO.FLOAT)
        out.update({name: value[:, :, c] for c, name in enumerate(names)})
        part += 1
    return out


def murmur3(name):
    """MurmurHash3_x86_32 with seed 0, and the Cryptomatte specification's change to its exponent."""
    data, h, mask = name.encode(), 0, 0xFFFFFFFF
    rotate = lambda x, by: ((x << by) | (x >> (32 - by))) & mask
    tail = len(data) // 4 * 4
    for i in range(0, len(data), 4):
        k = int.from_bytes(data[i:i + 4], "little") * 0xCC9E2D51 & mask
        k = rotate(k, 15) * 0x1B873593 & mask
        h ^= k
        if i < tail:
            h = (rotate(h, 13) * 5 + 0xE6546B64) & mask
    h ^= len(data)
    h = (h ^ h >> 16) * 0x85EBCA6B & mask
    h = (h ^ h >> 13) * 0xC2B2AE35 & mask
    h ^= h >> 16
    return h ^ (1 << 23) if h >> 23 & 255 in (0, 255) else h


def as_float(bits):
    return np.array([bits], "<u4").view("<f4")[0]


assert murmur3("hello") == 0x248BFA47  # a published value
code, _ = hoodoo("run", JOB, "--frames", "1001-1006", "--out", "own", "--progress", "none")
check(code == 0, "a run with pictures")
code, _ = hoodoo("run", JOB, "--frames", "1001-1006", "--out", "bare", "--progress", "none", "--set", "output.aov.cameras=[]")
check(code == 0 and not os.listdir("bare/aov"), "a run without")
code, said = hoodoo("aov", "bare", "--frames", "1002-1006x2", "--progress", "none")
check(code == 0 and sorted(os.listdir("bare/aov")) == [f"twelve.main.{f}.exr" for f in (1002, 1004, 1006)], "pictures of three frames: " + said.strip())
check(all(bytes_of(f"bare/aov/twelve.main.{f}.exr") == bytes_of(f"own/aov/twelve.{f}.exr") for f in (1002, 1004, 1006)),
      "they are what the run would have made, byte for byte")

MOVING = "cameras.shot={orbit: {target_m: [8, 4, 5], distance_m: 22, azimuth_deg: {1001: -55, 1006: 35}}, resolution: [64, 40], overscan: 0.1}"
code, said = hoodoo("aov", "own", "--camera", "shot", "--set", MOVING, "--set", "output.aov.samples=16", "--set",
                    "output.aov.cryptomatte=true", "--frames", "1001-1006x5", "--progress", "none")
check(code == 0, "another camera, moving: " + said.strip())
first, last = channels("own/aov/twelve.shot.1001.exr"), channels("own/aov/twelve.shot.1006.exr")
check(first["R"].shape == (48, 78), f"overscan widens the picture on all sides: {first['R'].shape}")
check(not np.allclose(first["N.X"], last["N.X"]) and abs(first["A"].mean() - last["A"].mean()) < 0.1, "it went around the rock")
edge = (first["A"] > 0) & (first["A"] < 1)
check(0 < edge.mean() < 0.2, f"edges are smooth: {100 * edge.mean():.0f} % of the pixels are partly rock")
check(set(np.unique(first["Z"] < 1e9)) == {False, True}, "depth has rock and nothing")

share = {}
for rank in range(6):
    name, pair = f"CryptoStrata{rank // 2:02d}", "RG" if rank % 2 == 0 else "BA"
    for k in range(2):
        hit = first[f"{name}.{pair[0]}"].astype("<f4") == as_float(murmur3(f"stratum_{k}"))
        share[k] = share.get(k, 0) + np.where(hit, first[f"{name}.{pair[1]}"], 0)
check(np.abs(share[0] + share[1] - first["A"]).max() < 2e-3, "the mattes of the strata add up to the rock's alpha")
inside = (first["A"] == 1) & (share[0] + share[1] > 0.999)
for k in range(2):
    pure = inside & (share[k] == 1)
    check(pure.sum() > 50 and (first["layer.id"][pure] == k).all(), f"where only stratum {k} is met, layer.id says so")

code, said = hoodoo("aov", "own", "--camera", "main", "--set", "output.aov.layers=[depth, layer]", "--set", "cameras.main.resolution=[32, 18]",
                    "--set", "output.aov.layout=single", "--frames", "1001", "--progress", "none")
check(code == 0 and sorted(channels("own/aov/twelve.main.1001.exr")) == ["Z", "layer.id"], "only the layers that were asked for")
check("own: 0 of " in hoodoo("verify", "own")[1], "the run's own pictures stay as their manifests know them")

code, said = hoodoo("aov", "own", "--camera", "nobody")
check(code == 2 and "nobody" in said, "an unknown camera: " + said.strip())
code, said = hoodoo("aov", "own", "--set", "output.aov.layers=[dept]")
check(code == 2 and "did you mean depth" in said, "a misspelt layer: " + said.strip())
code, said = hoodoo("aov", "own", "--frames", "1-9")
check(code == 3 and "1-9" in said, "frames that are not there: " + said.strip())
code, said = hoodoo("run", JOB, "--frames", "1001-1003", "--out", "small", "--progress", "none", "--set", "output.vdb.precision=16bit",
                    "--set", "output.vdb.half=true", "--set", "output.aov.cameras=[]")
code2, said = hoodoo("aov", "small", "--camera", "main", "--frames", "1003", "--progress", "none")
check(code == code2 == 0, "pictures of points in 16 bits and volumes in halves: " + said.strip())
small, exact = channels("small/aov/twelve.main.1003.exr"), channels("own/aov/twelve.1003.exr")
rock = (small["A"] > 0) & (exact["A"] > 0)
off = np.abs(small["P.X"] - exact["P.X"])[rock]
check(((small["A"] > 0) == (exact["A"] > 0)).mean() > 0.998 and (small["layer.id"] == exact["layer.id"]).mean() > 0.995 and np.median(off) < 2e-3,
      f"they show the same rock ({100 * ((small['A'] > 0) == (exact['A'] > 0)).mean():.2f} % of the pixels; P within {np.median(off):.1e} m)")
most = np.abs(exact["stress.von_mises"]).max()
worse = np.abs(small["stress.von_mises"] - exact["stress.von_mises"])[rock].max() / most
check(most > 65504 and worse < 1e-2, f"and the same stress, also beyond what halves can hold ({most:.3g} Pa; {worse:.1e} of it off at most)")
code, said = hoodoo("mesh", "small", "--frames", "1003", "--progress", "none")
check(code == 0 and os.path.getsize("small/mesh/twelve.1003.ply") > 10000, "and there is a mesh of it: " + said.strip())
os.truncate("bare/points/twelve.1003.vdb", 1000)
code, said = hoodoo("aov", "bare", "--frames", "1003")
check(code == 3 and "twelve.1003.vdb" in said and not os.path.exists("bare/aov/twelve.main.1003.exr"), "a damaged file: " + said.strip()[-90:])
os.remove("bare/points/twelve.1004.vdb")
code, said = hoodoo("aov", "bare", "--frames", "1004")
check(code == 3 and "output.vdb.points" in said, "no particles: " + said.strip()[-90:])

"""The bundle in an empty root folder: its own C library, loader and readers, and nothing else. tests/long/bundle.py gives it drivers."""

import json
import os
import shutil
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from packed import archive, inside, root, unpack
from script import *

if os.getuid() != 0:
    print("ok the bundle # skip needs root, for chroot")
    sys.exit(0)
MOST = 45 << 20
size = os.path.getsize(archive())
ok(size <= MOST, f"the archive has {size / 2**20:.1f} MiB", f"more than {MOST >> 20}")
bundle = unpack("bare/a folder")
name = bundle.removeprefix("bare")
code, said = ask("sha256sum", "--quiet", "--check", "MANIFEST.sha256", cwd=bundle)
ok(code == 0, "its manifest is true", said)
with open(bundle + "/MANIFEST.sha256") as file:
    listed = {line.split("  ", 1)[1].rstrip("\n") for line in file}
have = {os.path.relpath(os.path.join(d, f), bundle) for d, _, names in os.walk(bundle) for f in names} - {"MANIFEST.sha256"}
ok(listed == have, "and complete", listed ^ have)
with open(bundle + "/share/doc/hoodoo/licences/README.md") as file:
    table = file.read()
libraries = {p for p in have if ".so" in p and not p.endswith("hoodoo-vdb.so")}
ok(len(libraries) > 40 and all(p in table for p in libraries), "each library has its package, licence and source's address", [p for p in libraries if p not in table])

# In the bare root: no driver, so that everything up to the device works, images and meshes included.
import OpenImageIO as oiio
import numpy

os.makedirs("bare/w")
os.chmod("bare/w", 0o777)
for kind, suffix in (("uint16", "png"), ("uint8", "jpg"), ("uint16", "tif"), ("float32", "exr")):
    spec = oiio.ImageSpec(32, 32, 1, {"uint16": oiio.UINT16, "uint8": oiio.UINT8, "float32": oiio.FLOAT}[kind])
    out = oiio.ImageOutput.create("bare/w/map." + suffix)
    assert out.open("bare/w/map." + suffix, spec)
    out.write_image(numpy.full((32, 32, 1), 5, kind))
    out.close()
with open("bare/w/cube.obj", "w") as file:
    for i in range(8):
        file.write(f"v {4 + 8 * (i & 1)} {4 + 8 * (i >> 1 & 1)} {8 * (i >> 2)}\n")
    for a, b, c, d in ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)):
        file.write(f"f {a} {b} {c} {d}\n")
code, said = ask(HOODOO, "run", os.path.join(TOP, "tests/restart/twelve.yaml"), "--frames", "1001-1002", "--out", "bare/w/shot", "--device", "cpu")
assert code == 0, said
grid = next(f for f in sorted(os.listdir("bare/w/shot/volumes")))


def plan(shape):
    job = {"hoodoo": 1, "name": "bare", "frames": "1", "domain": {"size_m": [16, 16, 16], "spacing_m": 1}, "scene": shape}
    with open("bare/w/job.json", "w") as file:
        json.dump(job, file)
    return inside("bare", name + "/bin/hoodoo", "plan", "job.json", "--device", "none", "--json", cwd="/w")


with root("bare") as there:
    if not there:
        print("ok the bundle in an empty root # skip file systems cannot be mounted here")
        finish()
    begun = time.monotonic()
    code, said = inside("bare", name + "/bin/hoodoo", "--version")
    took = time.monotonic() - begun
    ok(code == 0 and said.startswith("hoodoo "), f"it starts in an empty root, in {1000 * took:.0f} ms", code, said)
    begun = time.monotonic()
    inside("bare", name + "/bin/hoodoo", "--version")
    took = time.monotonic() - begun
    ok(took < 0.5, f"and again in {1000 * took:.0f} ms")
    for suffix in ("png", "jpg", "tif", "exr"):
        code, said = plan({"heightfield": {"file": "map." + suffix, "min_m": [0, 0, 0], "max_m": [16, 16, 1], **({} if suffix == "exr" else {"scale_m": 1})}})
        ok(code == 0 and '"particles": 1280' in said, f"its reader reads {suffix}", said[-800:])
    with open("bare/w/map.gif", "wb") as file:
        file.write(b"GIF89a" + bytes(40))
    code, said = plan({"heightfield": {"file": "map.gif", "min_m": [0, 0, 0], "max_m": [16, 16, 1]}})
    ok(code == 3 and "reads PNG, JPEG, TIFF, OpenEXR and PGM" in said, "and says which formats it has", code, said)
    code, said = plan({"mesh": {"file": "cube.obj"}})
    ok(code == 0 and '"particles": 512' in said, "meshes are measured, with OpenVDB", said[-800:])
    code, said = inside("bare", name + "/bin/hoodoo", "inspect", "shot/volumes/" + grid, cwd="/w")
    ok(code == 0 and "density" in said, "OpenVDB's files are read", said[-800:])
    code, said = inside("bare", name + "/bin/hoodoo", "devices")
    ok(code in (0, 6) and "llvmpipe" not in said, "a machine without a driver is told so", code, said)
    code, said = inside("bare", name + "/bin/hoodoo", "run", "job.json", cwd="/w")
    ok(code == 6, "and a run there exits with 6", code, said)
    shutil.move(bundle, "bare/w/moved")
    code, said = inside("bare", "/w/moved/bin/hoodoo", "plan", "job.json", "--device", "none", cwd="/w")
    ok(code == 0, "the folder can be moved", said)
    os.rename("bare/w/moved/lib/programs", "bare/w/moved/lib/lost")
    code, said = inside("bare", "/w/moved/bin/hoodoo", "--version")
    ok(code == 127 and "unpack it again" in said, "an incomplete bundle says so", code, said)
finish()

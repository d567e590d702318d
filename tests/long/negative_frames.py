"""Frames below 0 in every verb that reads or writes their files, and output folders whose paths are long: whole, or refused."""

import json
import os

from script import finish, hoodoo, ok


def works(name, *words):
    code, said = hoodoo(*words)
    ok(code == 0, name, said)
    return said


def files(*paths):
    missing = [p for p in paths if not os.path.isfile(p)]
    ok(not missing, "there are " + ", ".join(paths), missing, *(os.listdir(os.path.dirname(p)) for p in missing if os.path.isdir(os.path.dirname(p))))


JOB = """hoodoo: 1
name: neg
model: arenite
frames: -12--10
domain: {size_m: [8, 8, 8], spacing_m: 1}
scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}
cameras: {a: {orbit: {}, resolution: [64, 36]}, b: {orbit: {azimuth_deg: 90}, resolution: [64, 36]}}
output: {aov: {cameras: [a]}}
checkpoint: {every: 1, mark: [-12]}
farm: {block_frames: 2, chunk_frames: 2, meshes: true, cameras: [b], still_every: 1, show: [stress], turntable: 3}
"""
SMALL = ("--resolution", "64x36", "--preset", "draft", "--progress", "none")
with open("neg.yaml", "w") as f:
    f.write(JOB)
with open("wedges.yaml", "w") as f:
    f.write(JOB.replace("turntable: 3", "turntable: 0").replace("show: [stress], ", "") + "wedge: {over: [{key: seed, values: [1, 2]}]}\n")

# The run, and the verbs that read it.
works("run", "run", "neg.yaml", "--out", "o", "--progress", "none", "--frames", "-12--10")
for folder, ending in (("points", "vdb"), ("points", "usdc"), ("volumes", "vdb"), ("frames", "json")):
    files(*(f"o/{folder}/neg.-00{n}.{ending}" for n in (12, 11, 10)))
files("o/checkpoint/neg.-0010.ckpt", "o/checkpoint/neg.-0012.keep", "o/aov/neg.-0011.exr")
answer = json.loads(works("status", "status", "o", "--json"))
ok(answer["done"] == 3 and answer["frames_done"] == ["-12--10"] and answer["frames"] == "-12--10" and answer["checkpoints"] == [-10, -11, -12], "status knows the frames", answer)
answer = json.loads(works("status --frames -11", "status", "o", "--json", "--frames", "-11"))
ok(answer["total"] == 1 and answer["done"] == 1, "of one frame", answer)
answer = json.loads(works("verify", "verify", "o", "--json"))
ok(answer["frames"] == 3 and answer["damaged"] == 0 and answer["missing"] == 0, "verify finds all", answer)
works("preview: stills", "preview", "o", *SMALL, "--frames", "-12--11")
files("o/preview/neg.-0012.png", "o/preview/neg.-0011.png", "o/neg.contact.png")
works("preview --show", "preview", "o", *SMALL, "--frames", "-10", "--show", "stress", "--keep-scenes")
files("o/preview/neg.stress.-0010.png", "o/preview/neg.stress.-0010.pov", "o/neg.stress.contact.png")
works("preview --turntable", "preview", "o", *SMALL, "--turntable", "--views", "3", "--keep-scenes")
files(*(f"o/turntable/neg.-0010.{n:03}.png" for n in range(3)), "o/turntable/neg.-0010.pov", "o/neg.turntable.mp4")
works("mesh", "mesh", "o", "--frames", "-12--11", "--progress", "none")
files(*(f"o/mesh/neg.-00{n}.{ending}" for n in (12, 11) for ending in ("ply", "obj")))
works("aov", "aov", "o", "--frames", "-12", "--camera", "c", "--set", "cameras.c={orbit: {azimuth_deg: 10}, resolution: [64, 36]}", "--progress", "none")
files("o/aov/neg.c.-0012.exr")
works("report", "report", "o")
with open("o/report/index.html") as f:
    page = f.read()
ok(all(word in page for word in ("checkpoint/neg.-0010.ckpt", "frame.-12.jpg", "frame.-11.jpg", "turntable.mp4")), "the report shows them", page[:2000])
for path in ("o/checkpoint/neg.-0010.ckpt", "o/volumes/neg.-0010.vdb", "o/aov/neg.-0010.exr", "o/frames/neg.-0010.json"):
    works("inspect " + path, "inspect", path)
with open("o/neg.usda") as f:
    ok("@./volumes/neg.-0012.vdb@" in f.read(), "the stage names them")
works("a branch from one of them", "run", "neg.yaml", "--out", "branch", "--from", "o@-11", "--progress", "none")
files("branch/checkpoint/neg.from.ckpt", "branch/volumes/neg.-0010.vdb")
os.remove("o/volumes/neg.-0011.vdb")
works("what is missing is made again", "run", "neg.yaml", "--out", "o", "--progress", "none", "--repair")
files("o/volumes/neg.-0011.vdb")

# The farm: every task is found done afterwards, so that the same command has nothing to do.
works("plan", "plan", "neg.yaml", "--out", "local", "--json")
works("submit --to local", "submit", "neg.yaml", "--to", "local", "--workers", "2", "--out", "local", "--progress", "none")
files("local/mesh/neg.-0012.obj", "local/aov/neg.b.-0011.exr", "local/preview/neg.-0010.png", "local/preview/neg.stress.-0010.png", "local/turntable/neg.-0010.002.png", "local/neg.contact.png", "local/neg.turntable.mp4")
answer = json.loads(works("status of a farm", "status", "local", "--json"))
ok(answer["tasks_done"] == answer["task_count"] > 6 and answer["done"] == 3, "all its tasks are done", answer)
works("submit --to openjd", "submit", "neg.yaml", "--to", "openjd", "--out", "local", "--dry-run")
works("wedges", "submit", "wedges.yaml", "--to", "local", "--workers", "2", "--out", "sweep", "--progress", "none")
files("sweep/w0001/preview/neg_w0001.-0010.png", "sweep/w0002/volumes/neg_w0002.-0012.vdb", "sweep/neg.wedges.png")
answer = json.loads(works("status of wedges", "status", "sweep", "--json"))
ok(answer["tasks_done"] == answer["task_count"] and [w["done"] for w in answer["wedges"]] == [3, 3], "all their tasks are done", answer)
works("report of wedges", "report", "sweep")
files("sweep/report/w0001.png", "sweep/report/index.html")

# A folder of 3,500 bytes is one like others; of a longer one nothing is made, least of all a shorter one.
here = os.getcwd() + "/long"
deep = here
while len(deep) < 3500:
    deep += "/" + "d" * min(200, max(1, 3500 - len(deep) - 1))
works("run into a path of %d bytes" % len(deep), "run", "neg.yaml", "--out", deep, "--progress", "none", "--frames", "-12")
works("preview there", "preview", deep, *SMALL)
works("report there", "report", deep)
ok(all(os.path.isfile(deep + "/" + name) for name in ("volumes/neg.-0012.vdb", "preview/neg.-0012.png", "report/index.html")), "their files are there")
for n in (3700, 4200, 9000):
    away = "/away" * (n // 5)
    for words in (("run", "neg.yaml", "--out", "." + away), ("submit", "neg.yaml", "--to", "local", "--out", "." + away), ("preview", "." + away), ("report", "." + away), ("status", "." + away)):
        code, said = hoodoo(*words)
        wanted = (2, 4) if words[0] in ("run", "submit") else (2, 3, 4)
        ok(code in wanted and not os.path.exists("away"), f"{words[0]}: {n} bytes are refused, and nothing is made", code, said[-300:])
        if words[0] in ("run", "submit"):
            ok("bytes long" in said, "with the bytes there are and may be", said[-300:])
finish()

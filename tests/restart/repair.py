"""Files that are flipped, truncated or removed are made again by `run`, checkpoints by `run --repair`, and no others; the folder is then the
same, byte for byte."""

import glob
import json
import os
import random
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from script import cut_half, flip_bit
from twelve import *

truth = Truth()
draw = random.Random(int(os.environ.get("SEED", "5")))
run("out")


def flip(path):
    flip_bit(os.path.join("out", path), draw)


def cut(path):
    cut_half(os.path.join("out", path))


def remove(path):
    os.remove(os.path.join("out", path))


def inodes():
    return {path: os.stat(os.path.join("out", path)).st_ino for path in tree("out")}


def verify():
    return subprocess.run([HOODOO, "verify", "out"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode


damaged = 0


def repaired(name, damage, frames, *options):
    """Calls `damage`; after a run all files must be as before, and those of other frames must not have been written again."""
    global damaged
    damaged += len(damage)
    before = inodes()
    for what, path in damage:
        what(path)
    found = verify()
    code, said = run("out", *options)
    after = inodes()
    # Every run rewrites the files of the whole sequence, with the same bytes.
    again = {path for path in after if before.get(path) != after[path] and not path.startswith(("job", "run", "checkpoint/", "records/"))
             and not path.endswith(".usda")}
    strangers = {path for path in again if not any(f".{frame}." in path for frame in frames)}
    ok(found == 3 and code == 0 and truth.differences("out") == "" and not strangers and verify() == 0, name, found, code,
       truth.differences("out"), strangers, said)
    print(f"# {name}: {len(again)} files written again")


ok(verify() == 0, "a whole folder verifies")
code, said = run("out", "--repair")
ok(code == 0 and "all 12 frames are done" in said, "and needs no repair", code, said)
repaired("a bit of a volume", [(flip, "volumes/twelve.1011.vdb")], [1011])
repaired("bits of points, a picture and a manifest", [(flip, "points/twelve.1003.vdb"), (flip, "aov/twelve.1007.exr"), (flip, "frames/twelve.1009.json")],
         [1003, 1007, 1009])
repaired("files cut and gone", [(cut, "aov/twelve.1012.exr"), (remove, "points/twelve.1001.vdb"), (remove, "frames/twelve.1005.json")], [1001, 1005, 1012])
repaired("a bit of the last checkpoint", [(flip, "checkpoint/twelve.1012.ckpt")], [], "--repair")
repaired("a bit of each checkpoint, and a frame", [(flip, "checkpoint/twelve.1012.ckpt"), (flip, "checkpoint/twelve.1010.ckpt"), (flip, "aov/twelve.1006.exr")],
         [1006], "--repair")
code, said = run("out", "--repair", "--frames", "1005-1006")
ok(code == 0, "a range of frames alone", code, said)
flip("volumes/twelve.1005.vdb")
code, said = run("out", "--repair", "--frames", "1005-1006")
ok(code == 0 and truth.differences("out") == "", "a block without a checkpoint before it is reached from the start", code, truth.differences("out"), said)


def content(path):
    with open(os.path.join("out", path)) as file:
        text = file.read()
    if path != "run.json":
        return text
    # Checkpoints do not contain the index of the device.
    return {key: value for key, value in json.loads(text).items() if key not in ("device_uuid", "device_pci")}


def damaged_provenance(name, path, damage):
    """Damages run.json or job.yaml; a run rewrites it, so that the folder can be identified again."""
    global damaged
    damaged += 1
    before = content(path)
    record = f"records/{path}.json"
    shutil.copy(os.path.join("out", path), "before")
    shutil.copy(os.path.join("out", record), "record")
    damage(os.path.join("out", path))
    found = verify()
    code, said = run("out")
    after, healed = content(path), verify()
    shutil.copy("before", os.path.join("out", path))
    shutil.copy("record", os.path.join("out", record))
    ok(found == 3 and code == 0 and after == before and healed == 0 and truth.differences("out") == "", name, found, code, before, after,
       healed, truth.differences("out"), said)


def edit(path):
    with open(path) as file:
        text = file.read()
    assert "\nseed: " in text
    with open(path, "w") as file:
        file.write(text.replace("\nseed: ", "\nseed: 1"))


damaged_provenance("job.yaml is lost", "job.yaml", os.remove)
damaged_provenance("job.yaml was edited", "job.yaml", edit)
damaged_provenance("run.json is lost", "run.json", os.remove)
damaged_provenance("run.json is cut", "run.json", lambda path: os.truncate(path, 10))

# A frame of another job among one's own, and a job.yaml that was edited: every verb that reads frames names them.
shutil.rmtree("other", ignore_errors=True)
code, said = run("other", "--frames", "1001-1003", "--set", "seed=99")
ok(code == 0, "another job", said)
for folder in ("points", "volumes", "aov", "frames"):
    for path in glob.glob(f"other/{folder}/twelve.1002.*"):
        shutil.copy(path, os.path.join("out", folder))
verbs = [["mesh", "out", "--frames=1002"], ["preview", "out", "--frames=1002", "--preset=draft", "--resolution=64x36", "--only=stills"],
         ["aov", "out", "--frames=1002", "--camera=main"], ["report", "out", "--no-pictures"]]
answers = [subprocess.run([HOODOO, *words], capture_output=True, text=True) for words in verbs]
with open("out/report/index.html") as file:
    page = file.read()
ok([a.returncode for a in answers[:3]] == [3, 3, 3] and all("1002 belongs to another job" in a.stderr for a in answers[:3]) and
   "belongs to another job" in page, "mesh, preview, aov and report name a frame of another job", answers)
code, said = run("out")
for path in ("out/report", "out/records/report"):
    shutil.rmtree(path)
ok(code == 0 and truth.differences("out") == "", "run makes it again", code, truth.differences("out"), said)
edit("out/job.yaml")
answers = [subprocess.run([HOODOO, *words], capture_output=True, text=True) for words in verbs]
with open("out/report/index.html") as file:
    page = file.read()
ok(all("job.yaml is not the job of the frames" in a.stderr for a in answers[:3]) and "job.yaml is not the job of the frames" in page,
   "and a job.yaml that is not the frames' job", answers)
fault("files of frames, checkpoints, job.yaml and run.json cut, flipped, edited or gone", damaged,
      "named by `verify`; `run` makes exactly these again with the same bytes")
finish()

"""Every product beside the frames has a record. When it is truncated, flipped or lost, `verify` names it, and the commands that it prints make
it again, byte for byte, in one pass. Two runs of all commands give the same bytes, and temporary names never look like finished files."""

import json
import os
import random
import shutil
import subprocess
import sys
import threading
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from script import *

# A slab with loose rocks: has a stage, clips, and shapes of points and rocks. Half a second per frame.
JOB = {"hoodoo": 1, "name": "made", "frames": "1001-1002", "clock": {"years_per_frame": 2000}, "seed": 3,
       "domain": {"size_m": [8, 8, 8], "spacing_m": 0.5},
       "scene": {"union": [{"box": {"min_m": [1, 1, 3], "max_m": [7, 7, 6]}}, {"box": {"min_m": [2, 2, 0], "max_m": [6, 6, 3], "inert": True}}]},
       "strata": [{"weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.01, "interlock_MPa": 0.2}],
       "cameras": {"main": {"orbit": {"target_m": [4, 4, 3], "distance_m": 20}, "resolution": [64, 36]}},
       "output": {"aov": {"cameras": ["main"]}, "usd": {"points": "surface"}}}
PICTURES = ("--preset=draft", "--resolution=64x36")
COMMANDS = (("mesh", "--adaptivity=0.2"), ("aov", "--set", "cameras.side={position_m: [-9, 4, 5], target_m: [4, 4, 3], resolution: [32, 18]}",
                                           "--camera", "side"),
            ("preview", *PICTURES, "--frames=1001-1002"), ("preview", "--show=stress", "--only=stills", "--frames=1002", *PICTURES),
            ("preview", "--turntable", "--views=2", *PICTURES), ("report",))
with open("made.json", "w") as file:
    json.dump(JOB, file)
draw = random.Random(int(os.environ.get("SEED", "1")))
seen, watching = set(), True


def watch():
    """Names that other programs would take for finished files."""
    while watching:
        time.sleep(0.005)
        for folder, _, names in os.walk("out"):
            seen.update(os.path.join(folder, name) for name in names if name.endswith((".png", ".exr", ".vdb", ".usda", ".mp4")))


def make(out):
    codes = [hoodoo("run", "made.json", "--out", out, "--progress", "none")]
    codes += [hoodoo(words[0], out, *words[1:]) for words in COMMANDS]
    return codes


def everything(path):
    return not path.startswith(("log", "checkpoint"))


def verify():
    done = subprocess.run([HOODOO, "verify", "out", "--json"], capture_output=True, text=True)
    return done.returncode, json.loads(done.stdout)


watcher = threading.Thread(target=watch)
watcher.start()
codes = make("out")
watching = False
watcher.join()
ok(all(code == 0 for code, _ in codes), "frames, meshes, other cameras, previews and a report are made", codes)
whole = tree("out", everything)
ok(seen <= {os.path.join("out", path) for path in whole}, "nothing half done has a name that is waited for", seen - {os.path.join("out", path) for path in whole})
records = [path for path in whole if path.startswith("records/")]
listed = {file["path"] for frame in (1001, 1002) for file in json.load(open(f"out/frames/made.{frame}.json"))["files"]}
without = {path for path in whole if not path.startswith(("records/", "frames/")) and path not in listed and f"records/{path}.json" not in whole}
ok(not without and len(records) > 20, "every file has a record or is in a manifest", without, len(records))
code, said = verify()
ok(code == 0 and said["products"] == len(records) and not said["commands"], "all is well", code, said)
shutil.copytree("out", "again")
for path in list(whole):
    if "report" not in path and ("preview/" in path or "turntable" in path or "contact" in path):
        os.remove(os.path.join("again", path))
codes = [hoodoo(words[0], "again", *words[1:]) for words in COMMANDS if words[0] == "preview"]
ok(all(code == 0 for code, _ in codes) and tree("again", everything) == whole, "pictures, sheets and videos that are made again are the same bytes", codes)


def kind(path):
    """The kind of a product: its path without numbers."""
    return "".join(c for c in path if not c.isdigit())


def flip(path):
    flip_bit(path, draw)


def shell(command):
    """Runs a printed command as a user would paste it; for `hoodoo run`, the user supplies the job."""
    if command.startswith("hoodoo run"):
        return hoodoo("run", "made.json", "--out", "out", "--progress", "none")
    return ask("sh", "-c", '"$HOODOO"' + command[len("hoodoo"):])


damaged = 0


def healed(name, damage, paths):
    """Damages all of these at once: each must be named, and the commands must restore it."""
    global damaged
    damaged += len(paths)
    for path in paths:
        damage(os.path.join("out", path))
    code, said = verify()
    found = {problem["file"] for problem in said["problems"]}
    made = [shell(command) for command in said["commands"]]
    after, healthy = tree("out", everything), verify()
    # The page contains times, and the device number in a lost run.json cannot be restored.
    unlike = {path for path in whole if after.get(path) != whole[path] and not path.endswith(("run.json", "run.json.json", "index.html", "index.html.json"))}
    ok(code == 3 and found == set(paths) and all(code == 0 for code, _ in made) and healthy[0] == 0 and not unlike,
       f"{name}: {len(paths)} kinds of files", code, found ^ set(paths), said["commands"], made, healthy, unlike)


def one_of_each(paths, least=1):
    """One product of each kind that has at least so many."""
    kinds = {}
    for path in sorted(paths):
        kinds.setdefault(kind(path), []).append(path)
    return [draw.choice(alike) for alike in kinds.values() if len(alike) >= least]


def any_of(*damages):
    return lambda path: draw.choice(damages)(path)


products = [path[len("records/"):-len(".json")] for path in records]
# Without run.json and job.yaml the folder cannot be identified; repair.py tests their loss.
once = [path for path in one_of_each(products) if path not in ("run.json", "job.yaml")]
thorough = float(os.environ.get("HOODOO_TEST_EFFORT", "1")) > 1
if thorough:
    for damage in (cut_half, flip, os.remove):
        healed(damage.__name__, damage, once)
else:
    healed("cut, flipped or gone", any_of(cut_half, flip, os.remove), once)
# The command of a product without a record is inferred from similar products.
if thorough:
    healed("records cut or flipped", any_of(cut_half, flip), one_of_each(records, least=2))
healed("job.yaml and records flipped", flip, ["job.yaml"] + [f"records/{path}.json" for path in ("run.json", "made.usda", "mesh/made.1001.ply")])

# Nothing tells what a file without a record is.
alone = ["made.usda", "mesh/made.1002.ply", "preview/made.1001.png", "turntable/made.1002.001.png", "report/frame.1001.jpg"]
damaged += len(alone)
for path in alone:
    os.remove(f"out/records/{path}.json")
for path in ("preview/notes.txt", "made.blend", "report/made.txt", "mesh/made.1001.abc"):
    with open("out/" + path, "w") as file:
        file.write("a user's own file")
code, said = verify()
named = {problem["file"] for problem in said["problems"]}
made = [shell(command) for command in said["commands"]]
ok(code == 3 and named == set(alone) and all(code == 0 for code, _ in made) and verify()[0] == 0,
   "files whose record is lost are named and made again; a user's own files are not", code, named ^ set(alone), made, verify())
code, said = hoodoo("run", "made.json", "--out", "out", "--progress", "none", "--resume", "never", "--set", "seed=4")
code, said = verify()
named = {problem["file"] for problem in said["problems"]}
ok(code == 3 and "mesh/made.1001.ply" in named and "preview/made.1002.png" in named and not named & {"made.usda", "run.json", "job.yaml"},
   "what an earlier run in this folder left is named", code, named)
for path in named:
    os.remove(os.path.join("out", path))
code, said = verify()
ok(code == 0 and said["products"] < 10, "and once it is gone, all is well", code, said)
fault("products and their records cut, flipped or gone", damaged, "named by `verify`, whose commands make them again with the same bytes")
finish()

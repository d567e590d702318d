"""submit --continue: a farm's folder whose job changed from a frame on keeps what is before. Only the blocks from there on run, the frames are
those of a new run, the change is recorded, and what cannot be kept is refused before anything is touched."""
import json
import os
import shutil
import sys

from script import finish, hoodoo, ok, tree

sys.dont_write_bytecode = True
ROCK = """hoodoo: 1
name: edits
frames: 1001-1012
clock: {years_per_frame: 1500}
seed: 3
domain: {size_m: [8, 8, 9], spacing_m: 0.5}
scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}
strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.02}]
edits:
  - frame: 1007
    carve: {sphere: {center_m: [4, 2, 4], radius_m: 1.2}}
checkpoint: {every: 4, keep: 9}
farm: {block_frames: 4, still_every: 0, turntable: 0}
"""
CHANGED = ROCK.replace("radius_m: 1.2", "radius_m: 1.5")
WEDGES = "wedge: {over: [{key: clock.years_per_frame, values: [1500, 1000]}]}\n"


def write(text):
    with open("edits.yaml", "w") as file:
        file.write(text)


def submit(out, *words):
    return hoodoo("submit", "edits.yaml", "--to", "local", "--out", out, *words)


def frames(out):
    """The files of frames. Blocks end with checkpoints that a single run does not make."""
    return tree(out, lambda path: path.split("/")[-2:-1] and path.split("/")[-2] in ("frames", "points", "volumes"))


def written(out, numbers):
    return {path: os.stat(f"{out}/{path}").st_ino for path in frames(out) if any(f".{n}." in path for n in numbers)}


def started(said):
    return [line.split(": started")[0].split()[-1] for line in said.splitlines() if ": started by worker" in line]


write(ROCK)
code, said = submit("before")
ok(code == 0 and len(started(said)) >= 3, "a submitted job", said)
write(CHANGED)
code, said = hoodoo("run", "edits.yaml", "--out", "fresh", "--progress", "none")
truth = frames("fresh")
ok(code == 0, "a new run of the changed job", said)

# All frames are done.
shutil.copytree("before", "out")
everything = tree("out", lambda path: True)
old = json.load(open("out/run.json"))["job_hash"]
code, said = submit("out")
ok(code == 7 and "differs in edits.0.carve.sphere.radius_m, which changes the simulation from frame 1007 on" in said and "--continue to keep frames 1001-1006" in said and tree("out", lambda path: True) == everything, "without --continue: exit 7 names the frame", code, said)
code, said = submit("out", "--continue", "--dry-run")
ok(code == 0 and "frames 1001-1006 are kept; frames 1007-1012 are removed and made again" in said and tree("out", lambda path: True) == everything,
   "--dry-run says what would be overwritten, and does nothing", code, said)
kept = written("out", range(1001, 1007))
code, said = submit("out", "--continue")
ok(code == 0 and said.index("frames 1007-1012 are removed") < said.index("started by worker"), "--continue says first what it overwrites", said)
blocks = [task for task in started(said) if task.startswith("sim.")]
ok(blocks == ["sim.1005-1008", "sim.1009-1012"], "only blocks from the change on run", blocks)
ok(frames("out") == truth, "the frames are those of a new run")
ok(kept and kept == written("out", range(1001, 1007)), "frames before the change were not written again")
record = json.load(open("out/run.json"))
ok(record.get("changed") == [{"frame": 1007, "job_hash": old}] and record["job_hash"] == json.load(open("fresh/run.json"))["job_hash"], "run.json records it", record)
code, said = hoodoo("verify", "out")
ok(code == 0, "and all verifies", said)
code, said = submit("out", "--continue")
ok(code == 0 and not [task for task in started(said) if task.startswith("sim.")] and json.load(open("out/run.json"))["changed"] == record["changed"], "again: nothing is left to do", said)

# Half of the frames are done, two of them of what changes, and the only checkpoint is of a frame that changes: what is before runs again, but is
# not written again.
write(ROCK)
code, said = hoodoo("run", "edits.yaml", "--out", "half", "--frames", "1001-1008", "--progress", "none", "--set", "checkpoint.keep=1")
write(CHANGED)
kept = written("half", range(1001, 1007))
code, said = submit("half", "--continue")
ok(code == 0 and frames("half") == truth and "frames 1007-1008 are removed" in said, "a folder that is half done", said)
ok("sim.1001-1004" in started(said) and kept and kept == written("half", range(1001, 1007)), "without a checkpoint from before, blocks run again, and their frames are kept", said)

# What cannot be kept.
write(ROCK.replace("seed: 3", "seed: 4"))
everything = tree("out", lambda path: True)
code, said = submit("out", "--continue")
ok(code == 7 and "from its first frame on" in said and tree("out", lambda path: True) == everything, "a change of the first frame: exit 7", code, said)
write(CHANGED)
code, said = submit("new", "--continue", "--dry-run")
ok(code == 0 and "--continue:" not in said, "a new folder: there is nothing to keep", said)

# Wedges: all are checked before one is touched.
write(ROCK + WEDGES)
code, said = submit("wedges")
ok(code == 0, "wedges", said)
everything = tree("wedges", lambda path: True)
write(CHANGED + WEDGES.replace("1000", "1100"))
code, said = submit("wedges", "--continue")
ok(code == 7 and "w0002" in said and tree("wedges", lambda path: True) == everything, "one wedge cannot be kept: none is touched", code, said)
write(CHANGED + WEDGES)
code, said = submit("wedges", "--continue")
sims = [task for task in started(said) if ".sim." in task]
ok(code == 0 and sorted(sims) == [f"w000{w}.sim.{block}" for w in (1, 2) for block in ("1005-1008", "1009-1012")], "in all wedges only blocks from the change on run", sims, said)
code, said = hoodoo("verify", "wedges")
ok(code == 0 and all(json.load(open(f"wedges/w000{w}/run.json"))["changed"][0]["frame"] == 1007 for w in (1, 2)), "they verify, and the change is recorded", said)
finish()

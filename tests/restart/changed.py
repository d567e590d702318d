"""run --continue: a folder whose job changed from a frame on keeps the frames before. The result is that of a run of the new job, byte for
byte, in all models, also if it is killed on the way; what cannot be kept is refused, and nothing is touched."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

from script import HOODOO, TOP, finish, hoodoo, ok, tree

sys.dont_write_bytecode = True
USAGE, CHECKPOINT = 2, 7
ROCK = """
hoodoo: 1
name: edits
frames: 1001-1006
clock: {years_per_frame: 1500}
seed: 3
domain: {size_m: [8, 8, 9], spacing_m: 0.5}
scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}
strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.02}]
rain: {m_per_yr: {1001: 0.3, 1003: 0.3, 1006: 0.6}}
edits:
  - frame: 1003
    set: {wind.speed_m_s: {1001: 12, 1006: 16}, clock.years_per_frame: 700.7}
  - frame: 1005
    carve: {sphere: {center_m: [4, 2, 4], radius_m: 1.2}}
cameras: {main: {orbit: {target_m: [4, 4, 3], distance_m: 20}, resolution: [48, 32]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 2}
"""
GOBLIN = """
hoodoo: 1
name: edits
model: goblins
frames: 1001-1006
clock: {years_per_frame: 700}
domain: {size_m: [10, 10, 10], spacing_m: 0.5}
scene: {box: {min_m: [2, 2, 0], max_m: [8, 8, 8]}}
strata:
  - {to_m: 4, weak_m_per_kyr: {1001: 0.5, 1004: 0.5, 1006: 0.6}}
  - {weak_m_per_kyr: 0.2}
checkpoint: {every: 2}
"""
TERRAIN = """
hoodoo: 1
name: edits
model: arches
frames: 1001-1006
domain: {size_m: [16, 12, 10], spacing_m: 0.5}
scene: {box: {min_m: [0, 0, 0], max_m: [16, 12, 7]}}
arches:
  sweeps: 4
  piles: {rock_m: 0.4, rocks: 20}
  operations:
    - {tool: noise, frames: 1001, strength: 0.8, scale_m: 4}
    - {tool: sweep, frames: 1001-1002, points_m: [[-1, 6, 4, 2], [8, 5, 4, 2.5], [17, 7, 4, 2]], roughness: 0.2}
    - {tool: erode, frames: 1002-1004, points_m: [[4, 6, 6, 2], [11, 6, 6, 2]], rocks: 0.7}
checkpoint: {every: 2}
"""


def changed(text, *pairs):
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new)
    return text


def write(text):
    with open("edits.yaml", "w") as file:
        file.write(text)


def run(out, *options):
    return hoodoo("run", "edits.yaml", "--out", out, "--progress", "plain", *options)


def files(out):
    """All files except what tells how they came about."""
    return tree(out, lambda path: not path.startswith(("log/", "run.json", "records/run.json")))


def last(said):
    return said.splitlines()[-1]


def differences(out, truth):
    here = files(out)
    return sorted(path for path in here.keys() | truth.keys() if here.get(path) != truth.get(path))


def inodes(out, frames):
    return {path: os.stat(os.path.join(out, path)).st_ino for path in files(out) if any(f".{f}." in path for f in frames) and "checkpoint" not in path}


made = {}


def check(what, before, after, frame, first=1001, final=1006):
    """Runs `before`, then continues with `after`, which differs from `frame` on."""
    for folder in ("out", "fresh"):
        shutil.rmtree(folder, ignore_errors=True)
    write(before)
    if before not in made:
        made[before] = f"before{len(made)}"
        code, said = run(made[before])
        ok(code == 0, f"{what}: the job before", code, said)
    shutil.copytree(made[before], "out")
    old = json.load(open("out/run.json"))["job_hash"]
    write(after)
    same = files("out")
    code, said = run("out")
    refused = frame <= final and code == CHECKPOINT and f"from frame {frame} on" in last(said) and f"--continue to keep frames {first}-{frame - 1}" in last(said)
    ok(refused and files("out") == same, f"{what}: refused without --continue, which it names with the frame", code, said)
    kept = inodes("out", range(first, frame))
    code, said = run("out", "--continue")
    ok(code == 0 and f"frames {first}-{frame - 1} are kept" in said, f"{what}: continues from {frame}", code, said)
    new, said = run("fresh")
    truth = files("fresh")
    ok(new == 0 and differences("out", truth) == [], f"{what}: the bytes of a new run", differences("out", truth), said)
    ok(kept and kept == inodes("out", range(first, frame)), f"{what}: the kept frames were not written again")
    record = json.load(open("out/run.json"))
    ok(record.get("changed") == [{"frame": frame, "job_hash": old}] and record["job_hash"] == json.load(open("fresh/run.json"))["job_hash"],
       f"{what}: run.json records it", record)
    code, said = hoodoo("verify", "out")
    ok(code == 0, f"{what}: and it verifies", code, said)


LATE = changed(ROCK, ("radius_m: 1.2", "radius_m: 1.5"))
check("a later edit", ROCK, LATE, 1005)
code, said = run("out", "--continue")
ok(code == 0 and "all 6 frames are done already" in said and len(json.load(open("out/run.json"))["changed"]) == 1, "once more: nothing to do", said)
check("a curve's later key", ROCK, changed(ROCK, ("1006: 0.6", "1006: 0.9")), 1004)
check("an edit more, and frames", ROCK, changed(ROCK, ("\ncameras:", "\n  - {frame: 1006, set: {wind.speed_m_s: 9}}\ncameras:"), ("1001-1006", "1001-1008")), 1006)
check("goblins", GOBLIN, changed(GOBLIN, ("1006: 0.6", "1006: 0.9")), 1005)
check("arches", TERRAIN, changed(TERRAIN, ("rocks: 0.7}", "rocks: 0.7}\n    - {tool: deposit, frames: 1005, points_m: [[8, 6, 9, 3]], thickness_m: 2}")), 1005)

# Frames that are only added need no option; a last frame may have had files that it has no longer.
write(ROCK)
shutil.rmtree("out")
run("out", "--set", "output.vdb.every=4")
write(changed(ROCK, ("1001-1006", "1001-1008")))
code, said = run("out", "--continue", "--set", "output.vdb.every=4")
shutil.rmtree("fresh")
run("fresh", "--set", "output.vdb.every=4")
ok(code == 0 and differences("out", files("fresh")) == [], "frames more, with files in some", differences("out", files("fresh")), said)

# Killed on the way: the same command, or without the option, ends with the same bytes.
shutil.rmtree("fresh")
shutil.copytree(made[ROCK], "before")
write(LATE)
run("fresh")
truth = files("fresh")
for number, option in enumerate([("--continue",), ()]):
    shutil.rmtree("out")
    shutil.copytree("before", "out")
    child = subprocess.Popen([HOODOO, "run", "edits.yaml", "--out", "out", "--continue", "--progress", "plain"], stderr=subprocess.DEVNULL)
    until = time.time() + 60
    for frame, there in ((1006, False), (1005, True))[:number + 1]:
        while os.path.exists(f"out/frames/edits.{frame}.json") != there and time.time() < until:
            time.sleep(0.001)
    child.send_signal(signal.SIGKILL)
    child.wait()
    code, said = run("out", *option)
    ok(code == 0 and differences("out", truth) == [], f"killed, then run {' '.join(option)}: the same bytes", code, differences("out", truth), said)

# Between run.json and job.yaml; and with the old frames still there.
for names in (("run.json", "records/run.json.json"), ("run.json", "records/run.json.json", "job.yaml", "records/job.yaml.json")):
    shutil.rmtree("out")
    shutil.copytree("before", "out")
    for name in names:
        shutil.copy(f"fresh/{name}", f"out/{name}")
    code, said = run("out")
    ok(code == 0 and differences("out", truth) == [], f"taken over up to {names[-1]}: any run ends with the same bytes", code, differences("out", truth), said)

# ---- refused

shutil.rmtree("out")
shutil.copytree("before", "out")
same = files("out")
WRONG = [
    ("a change from the first frame on", [("seed: 3", "seed: 4")], (), CHECKPOINT, "seed, which changes the simulation from its first frame on"),
    ("head handles", [("1001-1006", "991-1006")], (), CHECKPOINT, "begins at frame 991, which changes the age"),
    ("another name", [("name: edits", "name: other")], (), CHECKPOINT, "holds another job, edits"),
    ("other files", [("radius_m: 1.2", "radius_m: 1.5"), ("distance_m: 20", "distance_m: 21")], (), CHECKPOINT, "must be written alike"),
    ("never", [("radius_m: 1.2", "radius_m: 1.5")], ("--resume", "never"), USAGE, "choose one"),
]
for what, pairs, options, status, why in WRONG:
    write(changed(ROCK, *pairs))
    code, said = run("out", "--continue", *options)
    ok(code == status and why in last(said) and files("out") == same, f"{what}: {status}, and nothing is touched", code, said)
write(changed(ROCK, ("1001-1006", "993-1003")))
code, said = run("out")
ok(code == CHECKPOINT and "now begins at frame 993" in last(said) and files("out") == same, "head handles without --continue: 7 too", code, said)
finish()

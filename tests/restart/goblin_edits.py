"""Edits of goblins: what they add, carve, paint and set. The ledger is exact, and runs resumed across an edit, continued with a changed
one, and branched before one give the same bytes."""

import json
import os
import shutil

from script import finish, hoodoo, ok, tree

FRAMES = range(1001, 1009)
JOB = """hoodoo: 1
name: edits
model: goblins
frames: 1001-1008
clock: {years_per_frame: 300}
domain: {size_m: [8, 8, 8], spacing_m: 0.25}
scene: {box: {min_m: [1.5, 1.5, 0], max_m: [6.5, 6.5, 4]}}
strata:
  - {to_m: 2, weak_m_per_kyr: 0.4, bubble: {radius_m: 0.8}}
  - {weak_m_per_kyr: 0.3, bubble: {radius_m: 0.8}}
noise: {amplitude: 0.3, scale_m: 2}
goblins: {threshold: 0.5}
edits:
  - frame: 1001
    paint: [{shape: {box: {min_m: [0, 0, 0], max_m: [4, 8, 8]}}, erodibility: 0}]
  - frame: 1003
    add:
      - {shape: {cylinder: {from_m: [4, 4, 3], to_m: [4, 4, 6.5], radius_m: 1.2}}, layer: 0}
      - {shape: {sphere: {center_m: [1.5, 1.5, 7], radius_m: 0.6}}}
  - frame: 1005
    carve: {box: {min_m: [3.5, 1, 0.8], max_m: [8, 7, 1.5]}}
    paint: [{shape: {sphere: {center_m: [4, 4, 6], radius_m: 2}}, erodibility: 4}]
  - frame: 1007
    set: {goblins.threshold: 0.9, goblins.stress: true, strata.1.bubble.radius_m: 1.4, strata.0.weak_m_per_kyr: 0.8}
cameras: {main: {orbit: {target_m: [4, 4, 3], distance_m: 18}, resolution: [48, 32]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 3}
"""


def write(*pairs, name="job.yaml"):
    text = JOB
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new)
    with open(name, "w") as file:
        file.write(text)
    return name


def run(out, *options, job="job.yaml"):
    return hoodoo("run", job, "--out", out, "--progress", "none", *options)


def files(out):
    return tree(out, lambda path: path.split("/")[0] in ("points", "volumes", "aov", "frames"))


def frame(out, number):
    with open(f"{out}/frames/edits.{number}.json") as file:
        return json.load(file)


write()
code, said = run("whole")
ok(code == 0, "a run with edits", said)
truth = files("whole")
found = {f: frame("whole", f) for f in FRAMES}
books = {f: found[f]["ledger"] for f in FRAMES}
ok(all(b["start"] == b["rock"] + b["deposit"] + b["fallen"] + b["left"] for b in books.values()), "the ledger is exact in every frame", books)
ok([f for f in FRAMES if f > 1001 and books[f]["start"] > books[f - 1]["start"]] == [1003], "voxels are added in 1003 and in no other frame", books)
change = {f: {c: v for c, v in found[f]["statistics"].get("change_m3", found[f].get("change_m3", {})).items()} for f in FRAMES}
# The cylinder above the box, 3.1416 x 1.2^2 x 2.5 = 11.3 m3, and a ball in the air of 0.9 m3, which falls at once.
lost = found[1002]["statistics"]["volume_m3"] - found[1001]["statistics"]["volume_m3"]
ok(11 < change[1003]["edits"] < 13.5 and -1 < change[1003]["blocks"] < -0.8, "what is added, and a ball in the air that falls", change[1003])
ok(-13 < change[1005]["edits"] < -8 and books[1005]["left"] > books[1004]["left"] + 300, "what is carved has left", change[1005], books[1005])
total = {f: sum(change[f].values()) for f in FRAMES if f > 1001}
volume = {f: found[f]["statistics"]["volume_m3"] for f in FRAMES}
ok(all(abs(volume[f] - volume[f - 1] - total[f]) < 1e-3 for f in total), "the changes by process add up to the change of volume", volume, change)
code, said = run("plain", "--set", "edits=[]", "--frames", "1001-1002")
plain = frame("plain", 1002)["statistics"]["volume_m3"] - frame("plain", 1001)["statistics"]["volume_m3"]
ok(code == 0 and 0.4 < lost / plain < 0.6, "half of the rock is painted not to weather", lost, plain)
ok(found[1006]["statistics"]["max_stress_Pa"] == 0, "stress is shown from the edit on that turns it on", found[1006]["statistics"])
ok(found[1007]["statistics"]["stress_iterations"] > 0, "and not before", found[1007]["statistics"])

for last in (1002, 1003, 1005, 1006):
    shutil.rmtree("pieces", ignore_errors=True)
    first, _ = run("pieces", "--frames", f"1001-{last}")
    second, said = run("pieces")
    ok(first == 0 and second == 0 and files("pieces") == truth, f"in two pieces, cut after {last}: the same bytes", said)

write(("min_m: [3.5, 1, 0.8]", "min_m: [4.5, 1, 0.8]"))
code, said = run("pieces", "--continue")
other, _ = run("fresh")
ok(code == 0 and "frames 1001-1004 are kept" in said and other == 0 and files("pieces") == files("fresh") != truth, "continued with another carving: the bytes of a new run", said)

write(("frames: 1001-1008", "frames: 1004-1008"), name="branch.yaml")
code, said = run("marked", "--set", "checkpoint.mark=[1004]", "--frames", "1001-1004", job=write())
code, said = run("branch", "--from", "marked@1004", job="branch.yaml")
ok(code == 0 and all(frame("branch", f)["ledger"] == books[f] for f in range(1005, 1009)) and
   all(frame("branch", f)["statistics"] == found[f]["statistics"] for f in range(1005, 1009)), "a branch from before an edit goes on as the original did", said)

code, said = hoodoo("check", "job.yaml")
ok(code == 0 and "never made" not in said, "check finds every edit to be made", said)
code, said = hoodoo("check", "job.yaml", "--set", "edits.3.frame=1010")
ok("edits.3.frame" in said and "never made" in said, "and one after the last frame not", said)
code, said = hoodoo("check", "job.yaml", "--set", "edits.1.add.0.layer=2")
ok(code == 2 and "not one of the 2 strata" in said, "and no third stratum", said)
code, said = run("huge", "--set", "edits.3.set={strata.0.bubble.radius_m: 9}")
ok(code == 2 and "at most 15 are possible" in said, "an edit whose bubble does not fit the voxels is refused", code, said)
ok(not os.path.exists("huge/frames") or not os.listdir("huge/frames"), "before the first frame", said)
code, said = hoodoo("look", "job.yaml", "--frame", "1005", "--gizmos", "now", "--out", "look.png")
ok(code == 0 and "edits.2: frame 1005" in said, "look draws them", said)
finish()

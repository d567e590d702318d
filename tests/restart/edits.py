"""Edits and branches. Runs resumed across an edit, marked checkpoints, and branches from any checkpoint, also without the original,
give the same bytes. Impossible requests are refused with their exit code and change nothing."""

import hashlib
import json
import os
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
HOODOO = os.environ["HOODOO"]
JOB = os.path.join(os.environ["HOODOO_TOP"], "tests/restart/edits.yaml")
FRAMES = range(1001, 1011)
USAGE, INPUT, CHECKPOINT = 2, 3, 7
bad = 0


def ok(good, name, *seen):
    global bad
    print("ok" if good else "not ok", name)
    if not good:
        bad += 1
        print("   ", *seen)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout + done.stderr


def answer(*words):
    """The JSON that a verb prints."""
    done = subprocess.run([HOODOO, *words, "--json"], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    return json.loads(done.stdout) if done.returncode == 0 else {}


def run(out, *options, job=JOB):
    return hoodoo("run", job, "--out", out, "--progress", "plain", *options)


def tree(out, *folders):
    found = {}
    for folder, _, names in os.walk(out):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), out)
            if path.split("/")[0] in folders:
                with open(os.path.join(out, path), "rb") as file:
                    found[path] = hashlib.sha256(file.read()).hexdigest()
    return found


FILES = ("points", "volumes", "aov", "frames")


def checkpoint(out, frame, name="edits"):
    return os.path.join(out, "checkpoint", f"{name}.{frame}.ckpt")


def state(path):
    """The years and the hash of every section of a checkpoint."""
    code, said = hoodoo("inspect", path, "--json")
    if code:
        return said
    seen = json.loads(said)
    return seen["frame"], seen["years"], [(s["name"], s["hash"]) for s in seen["sections"]]


def ledger(out, frame, name="edits"):
    with open(os.path.join(out, "frames", f"{name}.{frame}.json")) as file:
        return json.load(file)["ledger"]


def last(said):
    """The single line of the error."""
    return (said.splitlines() or [""])[-1]


def other(name, *edits):
    """A copy of the job with another name and with lines replaced."""
    with open(JOB) as file:
        text = file.read().replace("name: edits", f"name: {name}")
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    with open(f"{name}.yaml", "w") as file:
        file.write(text)
    return f"{name}.yaml"


code, said = run("whole")
truth = tree("whole", *FILES)
ok(code == 0 and all(f"frames/edits.{f}.json" in truth for f in FRAMES), "a run with edits", code, said)
books = [ledger("whole", frame) for frame in FRAMES]
ok(all(b["start"] == b["rock"] + b["deposit"] + b["fallen"] + b["left"] for b in books), "its ledger is exact in every frame", books)
ok([books[i]["start"] > books[i - 1]["start"] for i in range(1, 10)] == [f == 1004 for f in range(1002, 1011)],
   "particles are added in 1004 and in no other frame", [b["start"] for b in books])
code, said = run("every", "--set", "checkpoint.every=1", "--set", "checkpoint.keep=99")

# ---- resumed

for frame in (1003, 1004, 1005, 1007):
    shutil.rmtree("pieces", ignore_errors=True)
    first, _ = run("pieces", "--frames", f"1001-{frame}")
    second, said = run("pieces", "--frames", f"{frame + 1}-1010")
    ok(first == 0 and second == 0 and tree("pieces", *FILES) == truth, f"in two pieces, cut after {frame}: the same bytes", said)
code, said = run("whole", "--set", "edits.1.add.1.layer=1")
ok(code == CHECKPOINT and "holds another job" in last(said), "another edit is another job: 7", code, said)

# ---- marked

code, said = run("pieces", "--set", "checkpoint.mark=[1002, 1005-1007x2]")
kept = sorted(name for name in os.listdir("pieces/checkpoint"))
ok(code == 0 and [n for n in kept if n.endswith(".keep")] == [f"edits.{f}.keep" for f in (1002, 1005, 1007)] and
   all(state(checkpoint("pieces", f)) == state(checkpoint("every", f)) for f in (1002, 1005, 1007)) and
   tree("pieces", *FILES) == truth, "marks added to a finished run: it makes their checkpoints, and changes nothing else", kept, said)
code, said = run("pieces", "--set", "checkpoint.mark=[1002, 1005-1007x2]")
ok(code == 0 and "all 10 frames are done already" in said, "once made, there is nothing to do", said)
code, said = run("marked", "--set", "checkpoint.mark=[1001, 1006]", "--set", "checkpoint.keep=1")
ok(code == 0 and sorted(os.listdir("marked/checkpoint")) == ["edits.1001.ckpt", "edits.1001.keep", "edits.1006.ckpt", "edits.1006.keep",
   "edits.1010.ckpt"], "marked frames outlast the others", os.listdir("marked/checkpoint"))

# ---- branched, unedited

job = other("twin", ("frames: 1001-1010", "frames: 1003-1010"))  # edits before the first frame are already in the checkpoint
for frame in (1003, 1006, 1009):
    shutil.rmtree("twin", ignore_errors=True)
    code, said = run("twin", "--from", f"every@{frame}", "--set", "checkpoint.every=1", "--set", "checkpoint.keep=99", job=job)
    here = sorted(int(n.split(".")[1]) for n in os.listdir("twin/frames"))
    ok(code == 0 and here == list(range(frame, 1011)) and
       all(state(checkpoint("twin", f, "twin")) == state(checkpoint("every", f)) for f in here) and
       all(ledger("twin", f, "twin") == ledger("whole", f) for f in here), f"an unedited branch from {frame} goes on as the original did", said)
code, said = hoodoo("verify", "twin")
ok(code == 0 and "2 frames" in said, "a branch is whole from its first frame on", said)
said = answer("status", "twin")
ok(said.get("frames") == "1009-1010" and said.get("missing") == 0, "and its status says so", said)
said = answer("plan", job, "--from", "every@1004")
ok(said.get("frame_count") == 7 and abs(said["years"] - (1500.3 + 5 * 700.7)) < 1e-6, "plan --from", said)

# ---- branched, edited

job = other("new", ("  - frame: 1006\n", "  - frame: 1005\n    add: [{shape: {box: {min_m: [6, 6, 4], max_m: [8, 8, 12]}}}]\n  - frame: 1006\n"),
            ("clock: {years_per_frame: 1500.3}", "clock: {years_per_frame: 1000}"), ("density_kg_m3: 2500", "density_kg_m3: 2600"))
shutil.copytree("every", "origin")
code, said = run("new", "--from", "origin@1004", job=job)
branch = tree("new", *FILES)
ok(code == 0 and ledger("new", 1004, "new") == ledger("whole", 1004) and ledger("new", 1005, "new")["start"] > ledger("whole", 1005)["start"],
   "an edited branch begins with the checkpoint's rock and edits it from there", code, said)
with open("new/frames/new.1006.json") as file:
    years = json.load(file)["years"]
ok(abs(years - (3 * 1500.3 + 1000 + 700.7)) < 1e-6, "its years go on from the checkpoint's, by its own clock", years)
with open("new/run.json") as file:
    paper = json.load(file)
ok(paper["from"]["frame"] == 1004 and paper["from"]["checkpoint"].endswith("origin/checkpoint/edits.1004.ckpt") and
   any(i["path"] == paper["from"]["checkpoint"] for i in paper["inputs"]), "run.json records where it came from", paper)
shutil.rmtree("again", ignore_errors=True)
first, _ = run("again", "--from", "origin@1004", "--frames", "1004-1006", job=job)
shutil.rmtree("origin")
second, said = run("again", "--from", "origin@1004", job=job)
ok(first == 0 and second == 0 and tree("again", *FILES) == branch, "continued with the original gone: the same bytes", second, said)
shutil.rmtree("again/frames")
for name in os.listdir("again/checkpoint"):
    if "from" not in name:
        os.remove(f"again/checkpoint/{name}")
code, said = run("again", "--from", "origin@1004", job=job)
ok(code == 0 and tree("again", *FILES) == branch, "begun again from its own copy: the same bytes", code, said)
code, said = run("again", job="again/job.yaml")
ok(code == 0 and "all 7 frames are done already" in said, "the branch's own job.yaml is the branch's job", code, said)
code, said = run("again", job=job)
ok(code == CHECKPOINT and "holds another job" in last(said), "without --from it is another job: 7", code, said)
code, said = run("again", "--from", "every@1003", job=job)
ok(code == CHECKPOINT and "holds another job" in last(said), "from another frame too", code, said)
with open("again/checkpoint/new.from.ckpt", "r+b") as file:
    file.truncate(1000)
code, said = hoodoo("verify", "again")
ok(code == INPUT and "new.from.ckpt" in said, "verify reads the copy, too", code, said)

# ---- branches with processes that the original lacks: flowing air, deposits

job = other("air", ("frames: 1001-1010", "frames: 1001-1008"))
more = ("--from", "every@1004", "--set", "wind.flow.solver=sph", "--set", "wind.flow.spacing_m=2", "--set", "deposition.viability=0.3")
code, said = run("air", *more, job=job)
first, _ = run("parts", *more, "--frames", "1004-1006", job=job)
second, _ = run("parts", *more, job=job)
ok(code == 0 and "starts from still air" in said and ledger("air", 1008, "air")["deposit"] > 0, "a branch may turn on flowing air and deposits", said)
ok(first == 0 and second == 0 and tree("parts", *FILES) == tree("air", *FILES), "and resumes in blocks with the same bytes", second)

# ---- refused


def refused(name, want, *options, job="new.yaml", says=""):
    shutil.rmtree("no", ignore_errors=True)
    code, said = run("no", *options, job=job)
    ok(code == want and last(said).startswith("hoodoo: ") and says in last(said) and not os.path.exists("no/job.yaml"), f"refused: {name}", code, said)


for text in ("every", "every@", "@1004", "every@x", "every@1e3", "every@99999999999999999999", "every@ 1004", "@", "every@0x3e9", "every@-"):
    refused(f"--from '{text}'", USAGE, "--from", text)
refused("no such folder", INPUT, "--from", "nothing@1004", says="nothing")
refused("no output folder", INPUT, "--from", "/tmp@1004")
refused("a missing checkpoint: the error lists the existing ones and the remedy", CHECKPOINT, "--from", "whole@1005",
        says="(its checkpoints are of frames 1007, 1010); to get one, run its job again with checkpoint.mark: [1005]")
refused("a frame that is not the job's", USAGE, "--from", "every@1004", "--set", "frames=1001-1003", says="1001-1003")
refused("a spacing that is no whole fraction", CHECKPOINT, "--from", "every@1004", "--set", "domain.spacing_m=0.3", says="0.3")
refused("another size", CHECKPOINT, "--from", "every@1004", "--set", "domain.size_m=[14, 14, 20]", says="28 x 28 x 32")
refused("other strata", CHECKPOINT, "--from", "every@1004", "--set", "strata.2={}", "--set", "strata.1.to_m=9", says="2 strata")
refused("another model", CHECKPOINT, "--from", "every@1004", "--set", "model=goblins", "--set", "edits=[]", says="model")
shutil.copytree("every", "hurt")
for name, damage in (("truncated", lambda f: f.truncate(5000)), ("flipped", lambda f: (f.seek(3000), f.write(b"hoodoo"))),
                     ("empty", lambda f: f.truncate(0))):
    shutil.copy(checkpoint("every", 1004), checkpoint("hurt", 1004))
    with open(checkpoint("hurt", 1004), "r+b") as file:
        damage(file)
    refused(f"a checkpoint that is {name}", CHECKPOINT, "--from", "hurt@1004", says="edits.1004.ckpt")
os.remove(checkpoint("hurt", 1004))
os.mkdir(checkpoint("hurt", 1004))
refused("a folder as a checkpoint", CHECKPOINT, "--from", "hurt@1004")
sys.exit(bad > 0)

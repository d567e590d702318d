"""Damaged checkpoints, lost and truncated files, and edited jobs are detected, reported, and repaired with the same bytes."""

import os
import shutil
import signal
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from twelve import *


def truncate(path):
    os.truncate(path, os.path.getsize(path) * 2 // 3)


def flip(path):
    with open(path, "r+b") as file:
        file.seek(os.path.getsize(path) // 2)
        byte = file.read(1)[0]
        file.seek(-1, os.SEEK_CUR)
        file.write(bytes([byte ^ 16]))


def empty(path):
    os.truncate(path, 0)


truth = Truth()
code, _ = stop("base", 1008, signal.SIGTERM)
ok(code == STOPPED and checkpoints("base") == [1007, 1008], "a run stopped after frame 1008", checkpoints("base"))


def fresh(source="base"):
    shutil.rmtree("run", ignore_errors=True)
    shutil.copytree(source, "run")


def warnings(said):
    return [line for line in said.splitlines() if line.startswith("hoodoo: warning: ")]


def same(name, code, said, more=True):
    ok(code == 0 and more and truth.differences("run") == "", name, code, truth.differences("run"), said)


# ---- checkpoints

for damage in (truncate, flip, empty):
    fresh()
    damage(checkpoint("run", 1008))
    code, said = run("run")
    same(f"newest checkpoint ({damage.__name__}): one warning names it, the one before is used", code, said,
         len(warnings(said)) == 1 and "twelve.1008.ckpt" in warnings(said)[0] and "checkpoint of frame 1007" in said)
fresh()
flip(checkpoint("run", 1007)), truncate(checkpoint("run", 1008))
written = os.stat(manifest("run", 1003)).st_mtime_ns
code, said = run("run")
same("all checkpoints damaged: a warning each, then from the first frame, whose files stay", code, said,
     len(warnings(said)) == 2 and os.stat(manifest("run", 1003)).st_mtime_ns == written)
fresh()
flip(checkpoint("run", 1007)), truncate(checkpoint("run", 1008))
code, said = run("run", "--frames", "1009-1012")
ok(code == CHECKPOINT and len(errors(said)) == 1, "all damaged, and a block that cannot begin: 7", code, said)
code, said = run("run", "--resume", "require")
ok(code == CHECKPOINT and len(errors(said)) == 1, "all damaged and --resume require: 7", code, said)
fresh()
shutil.copy(checkpoint("run", 1007), checkpoint("run", 1008))
code, said = run("run")
ok(code in (0, CHECKPOINT) and (code or truth.differences("run") == ""), "a checkpoint under another frame's name does no harm", code,
   truth.differences("run"), said)
fresh()
os.remove(checkpoint("run", 1008))
os.mkdir(checkpoint("run", 1008))
code, said = run("run")
ok(code in (0, OUTPUT) and len(errors(said)) == (code != 0), "a folder where a checkpoint should be", code, said)

# ---- frames

for path in ("points/twelve.1011.vdb", "volumes/twelve.1005.vdb", "aov/twelve.1001.exr", "frames/twelve.1012.json", "aov/twelve.1012.exr"):
    for damage in (os.remove, truncate):
        fresh("whole")
        damage(os.path.join("run", path))
        code, said = run("run")
        frame = path.split(".")[1]
        same(f"{path} ({damage.__name__}): made again", code, said, f"hoodoo: frame {frame}, 12/12" in said)
fresh("whole")
for path in sorted(truth.whole)[::7]:
    if not path.startswith("checkpoint"):
        os.remove(os.path.join("run", path))
shutil.rmtree("run/checkpoint")
code, said = run("run")
same("many files lost, and all checkpoints", code, said)
fresh()
for path in ("points/twelve.1009.vdb.tmp-1-2-3", "frames/twelve.1009.json.tmp-77-0-0", "checkpoint/twelve.1009.ckpt.tmp-9-9-9",
             "job.yaml.tmp-1-1-1"):
    with open(os.path.join("run", path), "w") as file:
        file.write("half a file")
    os.utime(os.path.join("run", path), (0, 0))  # an old file of another machine
code, said = run("run")
same("temporary files of a dead run are removed", code, said)

# ---- another job

edit = ("--set", "strata.0.weak_m_per_kyr=0.3")
fresh()
before = tree("run")
code, said = run("run", *edit)
ok(code == CHECKPOINT and len(errors(said)) == 1 and "--out" in said and "--resume never" in said and tree("run") == before,
   "an edited job in the same folder: 7, one line that says what to do, and nothing is touched", code, said)
code, said = run("run", *edit, "--resume", "never")
run("edited", *edit)
ok(code == 0 and tree("run") == tree("edited") and tree("run") != truth.whole, "--resume never starts over: as in a new folder", code, said)
fresh("whole")
code, said = run("run", "--resume", "never")
same("--resume never, same job: simulated again", code, said, "hoodoo: frame 1001, 1/12" in said)


def verify(out):
    done = subprocess.run([os.environ["HOODOO"], "verify", out], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return done.returncode, done.stdout + done.stderr


code, said = verify("whole")
ok(code == 0, "verify: a whole run", code, said)
fresh("whole")
for kind in ("frames", "points", "volumes", "aov"):
    for name in os.listdir(os.path.join("edited", kind)):
        if ".1004." in name:
            shutil.copy2(os.path.join("edited", kind, name), os.path.join("run", kind, name))
code, said = verify("run")
ok(code == 3 and "damaged frames/twelve.1004.json: it belongs to another job" in said and "1 damaged" in said and 'run "hoodoo run"' in said,
   "verify: a frame of another job is named", code, said)
code, said = run("run")
same("and the next run makes it again", code, said)
with open("run/job.yaml") as file:
    text = file.read()
with open("run/job.yaml", "w") as file:
    file.write(text.replace("seed: 3", "seed: 4"))
code, said = verify("run")
ok(code == 3 and "damaged job.yaml: it is not the job of the frames" in said and "1 damaged" in said, "verify: an edited job.yaml is named", code, said)
fresh()
code, said = run("run", "--set", "checkpoint.keep=4", "--set", "farm.retries=1", "--set", "cameras.spare={orbit: {distance_m: 9}}")
ok(code == 0 and "continuing" in said, "what is in no frame may change: it goes on", code, said)
fresh()
with open("run/job.yaml", "w") as file:
    file.write("hoodoo: 1\nname: [\n")
code, said = run("run")
same("an unreadable job.yaml is rewritten, since run.json shows that the frames belong to this job", code, said)
fresh()
with open("run/job.yaml", "w") as file:
    file.write("hoodoo: 1\nname: [\n")
os.remove("run/run.json")
before = tree("run")
code, said = run("run")
ok(code == CHECKPOINT and len(errors(said)) == 1 and tree("run") == before, "neither can be read: 7, and nothing is touched", code, said)
finish()

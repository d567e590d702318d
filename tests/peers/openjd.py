"""The real OpenJD client takes our template, runs it to the last sheet, and a task it cancels goes on where it was."""

import json
import os
import re
import signal
import subprocess
import sys
import time

from script import HOODOO, TOP, ask, finish, ok, tree

VENV = os.path.join(os.path.dirname(HOODOO), "openjd")
OPENJD = os.path.join(VENV, "bin", "openjd")
PATIENCE = 600


def by_openjd(path):
    return path.startswith(("points", "volumes", "aov", "frames", "job.yaml"))


def manifests(out):
    folder = os.path.join(out, "frames")
    return sorted(n for n in os.listdir(folder) if n.endswith(".json")) if os.path.isdir(folder) else []


if not os.path.exists(OPENJD):
    code, said = ask("python3", "-m", "venv", VENV)
    code, said = (code, said) if code else ask(os.path.join(VENV, "bin", "pip"), "install", "--quiet", "openjd-cli==0.8.0")
    if code:
        ok(False, "openjd-cli can be installed", said)
        sys.exit(1)

with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as f:
    text = f.read()
FARM = "farm: {block_frames: 6, chunk_frames: 3, meshes: true, still_every: 5, turntable: 0}\n"
with open("job.yaml", "w") as f:
    f.write(text + FARM + "wedge: {over: [{key: seed, values: [3, 4]}]}\n")
with open("long.yaml", "w") as f:
    f.write(text.replace("spacing_m: 0.5", "spacing_m: 0.25") + FARM)

# A folder whose name means harm: to shells, format strings, and to whoever reads stdout line by line.
out = os.path.abspath("a $(touch pwned) 'q' {{Param.X}}")
code, said = ask(HOODOO, "submit", "job.yaml", "--to", "openjd", "--device", "cpu", "--out", out)
ok(code == 0, "a template is written", said)
template = os.path.join(out, "twelve.openjd.json")
code, said = ask(OPENJD, "check", template)
ok(code == 0, "openjd check", said)
code, dry = ask(HOODOO, "submit", "job.yaml", "--to", "openjd", "--device", "cpu", "--out", out, "--dry-run")
with open(template) as f:
    written = f.read()
ok(code == 0 and json.loads(dry) == json.loads(written) and "$(" not in written, "--dry-run prints the same, and nobody's folder is in it")
code, said = ask(OPENJD, "run", template, "--step", "Wedges", "--run-dependencies")
ok(code == 0 and os.path.exists(out + "/twelve.wedges.png"), "openjd run with dependencies, to the sheet across wedges", said)
progress = [float(n) for n in re.findall(r"openjd_progress: ([0-9.]+)", said)]
ok(len(progress) > 24 and progress.count(100.0) >= 4, f"its tasks tell their progress ({len(progress)} times)")
for wedge in (1, 2):
    alone = f"alone{wedge}"
    ask(HOODOO, "run", "job.yaml", f"--wedge={wedge}", "--device", "cpu", "--out", alone, "--progress", "none")
    here, there = tree(f"{out}/w000{wedge}", by_openjd), tree(alone, by_openjd)
    ok(here == there and len(here) > 40, f"wedge {wedge}: the files of an undisturbed run, byte for byte",
       sorted(p for p in here.keys() | there.keys() if here.get(p) != there.get(p)))
    stills = sorted(n for n in os.listdir(f"{out}/w000{wedge}/preview") if n.endswith(".png"))
    ok([n.split(".")[1] for n in stills] == ["1001", "1006", "1011", "1012"], f"wedge {wedge}: the stills asked for", stills)

# Other frames and wedges, from the same template.
code, said = ask(OPENJD, "run", template, "--step", "Stills", "-p", "Wedges=2", "-p", "StillFrames=1003-1004")
have = [os.path.exists(f"{out}/w000{w}/preview/twelve_w000{w}.1003.png") for w in (1, 2)]
ok(code == 0 and have == [False, True], "resubmitted with other frames and one wedge", said)
code, said = ask(OPENJD, "run", template, "--step", "Mesh_1007-1012", "-p", "Wedges=1")
ok(code == 0 and len(os.listdir(f"{out}/w0001/mesh")) == 3 * 6 + 1, "meshes in chunks", said)
ok(not any("pwned" in names for _, _, names in os.walk(".")), "no path was taken for a command")

# A job of a million frames, and one on CPUs: what it requires of a worker.
code, said = ask(HOODOO, "submit", "job.yaml", "--to", "openjd", "--out", "million", "--set", "frames=1-1000000", "--set", "farm.block_frames=10000", "--set", "farm.still_every=7",
                 "--set", "farm.chunk_frames=100", "--set", "farm.on_done=[echo, done]")
ok(code == 0, "a template of a million frames is written", said)
code, said = ask(OPENJD, "check", "million/twelve.openjd.json")
ok(code == 0, "openjd check of a million frames", said)
code, said = ask(OPENJD, "summary", "million/twelve.openjd.json")
ok(code == 0 and "Total steps: 204" in said, "openjd summary", said[-2000:])
with open(template) as f:
    amounts = {a["name"]: a["min"] for a in json.load(f)["steps"][0]["hostRequirements"]["amounts"]}
ok(set(amounts) == {"amount.worker.vcpu", "amount.worker.memory"} and amounts["amount.worker.memory"] > 150, "with --device cpu a worker needs no GPU", amounts)

# Cancelled, then run again.
code, said = ask(HOODOO, "submit", "long.yaml", "--to", "openjd", "--device", "cpu", "--out", "long")
run = [OPENJD, "run", "long/twelve.openjd.json", "--step", "Sim_1001-1006"]
with open("cancelled.log", "w") as log:
    child = subprocess.Popen(run, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, start_new_session=True)
    end = time.monotonic() + 120
    while not manifests("long") and time.monotonic() < end and child.poll() is None:
        time.sleep(0.02)
    child.send_signal(signal.SIGINT)
    child.wait(PATIENCE)
with open("cancelled.log") as f:
    said = f.read()
before = manifests("long")
ok(0 < len(before) < 6 and "stopped after frame" in said, f"a cancelled task saves what it has ({len(before)} frames)", before, said)
code, said = ask(*run)
ok(code == 0 and len(manifests("long")) == 6 and "continuing from the checkpoint" in said, "and goes on when it is run again", said)
finish()

"""A block of frames that take seconds each, under a time limit shorter than the block, on a real Slurm: Slurm tells it in time, it saves between two frames,
exits with 85, is queued again, and continues there, to the bytes of an undisturbed run. Nothing is killed and no frame is simulated twice."""

import json
import os
import re
import shutil
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../peers/lib"))
from one_node import OneNode
from script import HOODOO, TOP, ask, finish, of_a_run, ok, tree

if not shutil.which("slurmctld") or not shutil.which("slurmd"):
    print("ok Slurm's notice before a limit # skip no Slurm")
    sys.exit(0)
os.environ["LP_NUM_THREADS"] = "1"
LIMIT_S, NOTICE_S, FRAMES = 300, 180, 60
with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as f:
    text = f.read()
# No checkpoint but the last one, and those that the notice makes. Slurm counts limits in minutes.
for old, new in (("1001-1012", f"1001-{1000 + FRAMES}"), ("years_per_frame: 2000", "years_per_frame: 300"), ("spacing_m: 0.5", "spacing_m: 0.1"), ("every: 3", "every: 1000")):
    assert old in text
    text = text.replace(old, new)
text += f"farm: {{block_frames: {FRAMES}, still_every: 0, turntable: 0, sim: {{cpus: 1, hours: {LIMIT_S / 3600:.6f}}}}}\n"
with open("job.yaml", "w") as f:
    f.write(text)
TASK = f"sim.1001-{1000 + FRAMES}"

with OneNode(requeue_exit=False) as slurm:
    code, said = ask(HOODOO, "submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", "out")
    if not ok(code == 0, "a block is submitted", said):
        finish()
    with open("out/farm/slurm.json") as f:
        job = {row["task"]: row["job"] for row in json.load(f)["tasks"]}[TASK]
    ok("TimeLimit=00:05:00" in slurm.ask("scontrol", "show", "job", job), "with a limit of five minutes", slurm.ask("scontrol", "show", "job", job))
    slurm.wait_for(lambda: not slurm.ask("squeue", "--noheader").strip(), "an empty queue", 1500)

with open(f"out/log/farm/{TASK}.jsonl") as f:
    events = [json.loads(line) for line in f if line.strip()]
ends = [e for e in events if e["event"] == "end"]
with open(f"out/log/farm/{TASK}.log") as f:
    log = f.read()
with open("out/log/run.log") as f:
    simulated = [int(n) for n in re.findall(r" frame (\d+), \d+/", f.read())]
print("# tries:", *(f"exit {e['exit']} after {e['seconds']} s;" for e in ends))
ok(len(ends) >= 2 and [e["exit"] for e in ends] == [85] * (len(ends) - 1) + [0], "it exits with 85 until its last frame is done", ends, log[-2000:])
# Slurm may give notice up to a minute early.
ok(all(LIMIT_S - NOTICE_S - 65 <= e["seconds"] <= LIMIT_S - 60 for e in ends[:-1]), "soon after the notice, long before the limit", ends)
ok(log.count("saved and stopped; queued again") == len(ends) - 1 and "stopped by Slurm" not in log, "it saved and was queued again, and was never killed", log[-2000:])
ok(simulated == list(range(1001, 1001 + FRAMES)), "every frame is simulated once", simulated)
code, said = ask(HOODOO, "run", "job.yaml", "--device", "cpu", "--out", "alone", "--progress", "none")
here, there = tree("out", of_a_run), tree("alone", of_a_run)
different = sorted(p for p in here.keys() | there.keys() if here.get(p) != there.get(p))
ok(code == 0 and not different and len(here) > FRAMES, "the files are those of an undisturbed run", said[-500:], different)
ok(ask(HOODOO, "verify", "out")[0] == 0, "and verify")
finish()

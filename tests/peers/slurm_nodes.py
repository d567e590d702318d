"""A job on a Slurm of three nodes whose disk shows each other's files seconds late: a node dies within a block, the next has another driver, which
is refused (exit 7) and excluded, and the third continues. In the end, the bytes of an undisturbed run. tests/long/slurm_nodes.py does this to 200 tasks."""

import json
import os
import subprocess
import sys
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "lib"))
from three_nodes import ThreeNodes, begin
from script import HOODOO, TOP, ask, finish, of_a_run, ok, tree

begin()


def read(path):
    return open(path).read() if os.path.exists(path) else ""


def frames(root):
    return len([n for n in os.listdir(root + "/frames") if n.endswith(".json")]) if os.path.isdir(root + "/frames") else 0


with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as file:
    job = file.read().replace("spacing_m: 0.5", "spacing_m: 0.25").replace("every: 3", "every: 1")
with open("job.yaml", "w") as file:
    file.write(job + "farm: {block_frames: 6, chunk_frames: 6, meshes: true, still_every: 0, turntable: 0, retries: 3, sim: {cpus: 1}}\n")
code, said = ask(HOODOO, "run", "job.yaml", "--device", "cpu", "--out", "alone", "--progress", "none")
code, said = ask(HOODOO, "mesh", "alone") if code == 0 else (code, said)
ok(code == 0, "an undisturbed run", said)
with ThreeNodes("shared", "disk") as slurm:
    out, real = slurm.shared + "/out", slurm.disk + "/out"
    slurm.open("a", "b")
    # Submitted on a machine with its own view, too.
    submit = ["unshare", "--mount", "sh", "-c", 'bindfs "$0" "$1" && shift && exec "$@"', slurm.disk, slurm.shared]
    code, said = ask(*submit, HOODOO, "submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", out)
    if not ok(code == 0, "a job is submitted", said):
        finish()
    log, tries = real + "/log/farm/sim.1001-1006.log", real + "/log/farm/sim.1001-1006.jsonl"
    slurm.wait_for(lambda: frames(real) >= 2, "two frames", 120)
    first = [line.split()[2] for line in slurm.queue() if line.startswith("twelve.sim.1001-1006 RUNNING")]
    if not ok(first in (["a"], ["b"]), "a block runs on a or b", slurm.queue()):
        finish()
    slurm.open("c")
    slurm.kill(first[0])
    ok(frames(real) < 6, f"node {first[0]} dies within the block, after {frames(real)} frames")
    slurm.wait_for(lambda: '"excluded", "node": "c"' in read(tries), "node c to be refused", 180)
    ok("on c: exit 7: another device, driver or build than that of the frames; queued again without c" in read(log) and "128 bits" in read(log), "node c, with another driver, is refused and excluded",
       read(log)[-2500:])
    slurm.open({"a": "b", "b": "a"}[first[0]])
    slurm.wait_for(lambda: not slurm.queue(), "an empty queue", 300)
    end = json.loads(read(real + "/farm/end.json") or "{}")
    ok(end.get("state") == "done" and end["tasks_done"] == end["tasks"], "all tasks are done, and the end knows it through the late disk", end)
got, wanted = tree(real, of_a_run), tree("alone", of_a_run)
wanted.pop("job.yaml", None)
got.pop("job.yaml", None)
ok(got == wanted and len(got) > 40, f"{len(got)} files are those of the undisturbed run", sorted(p for p in got.keys() | wanted.keys() if got.get(p) != wanted.get(p)))
finish()

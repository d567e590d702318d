"""205 tasks on a Slurm of three nodes whose disk shows each other's files seconds late, and one of which has another driver, while 20 times a process or
a whole node is killed: in the end, the bytes of an undisturbed run."""

import json
import os
import random
import signal
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.environ["HOODOO_TOP"], "tests/peers/lib"))
from three_nodes import ThreeNodes, begin
from script import HOODOO, TOP, ask, finish, of_a_run, ok, tree

KILLS, NODES = 20, 5
begin()
with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as file:
    job = file.read().replace("frames: 1001-1012", "frames: 1001-1068").replace("every: 3", "every: 1")
with open("job.yaml", "w") as file:
    file.write(job + "farm: {block_frames: 2, chunk_frames: 1, meshes: true, still_every: 0, turntable: 0, retries: 12, sim: {cpus: 1}}\n"
               "wedge: {over: [{key: seed, values: [3, 4]}]}\n")
for wedge in (1, 2):
    code, said = ask(HOODOO, "run", "job.yaml", f"--wedge={wedge}", "--device", "cpu", "--out", f"alone{wedge}", "--progress", "none", timeout=1800)
    code, said = ask(HOODOO, "mesh", f"alone{wedge}", timeout=1800) if code == 0 else (code, said)
    ok(code == 0, f"an undisturbed run of wedge {wedge}", said)
draw = random.Random(7)
with ThreeNodes("shared", "disk") as slurm:
    out, real = slurm.shared + "/out", slurm.disk + "/out"
    submit = ["unshare", "--mount", "sh", "-c", 'bindfs "$0" "$1" && shift && exec "$@"', slurm.disk, slurm.shared]
    slurm.open("a", "b")
    code, said = ask(*submit, HOODOO, "submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", out)
    if not ok(code == 0, "a job is submitted", said):
        finish()
    tasks = len(slurm.queue())
    ok(tasks >= 200, f"{tasks} tasks are queued")
    slurm.wait_for(lambda: os.path.isdir(real + "/w0002/frames") and os.listdir(real + "/w0002/frames"), "frames of both wedges", 300)
    slurm.open("a", "b", "c")
    killed, nodes, dead, end = 0, 0, None, time.monotonic() + 3000
    while slurm.queue() and time.monotonic() < end:
        time.sleep(4)
        if dead and time.monotonic() > dead[1]:
            slurm.boot(dead[0])
            dead = None
        if killed == KILLS:
            continue
        if nodes < NODES and not dead and draw.random() < 0.3:
            node = draw.choice("ab")
            slurm.kill(node)
            dead = (node, time.monotonic() + 25)
            nodes += 1
            killed += 1
            continue
        running = [p for node in "abc" for p in slurm.processes(node) if os.path.exists(f"/proc/{p}/exe") and os.path.basename(os.readlink(f"/proc/{p}/exe")).startswith("hoodoo")]
        if running:
            os.kill(draw.choice(running), signal.SIGKILL)
            killed += 1
    ok(not slurm.queue(), "the queue is empty", "\n".join(slurm.queue()))
    with open(real + "/farm/end.json") as file:
        said = json.load(file)
    ok(said["state"] == "done" and said["tasks"] == said["tasks_done"], f"all {said['tasks']} tasks are done, after {killed} kills, of them {nodes} of nodes", said)
    ok(killed == KILLS, f"{KILLS} times something was killed", killed)
for wedge in (1, 2):
    got, wanted = tree(f"{real}/w000{wedge}", of_a_run), tree(f"alone{wedge}", of_a_run)
    ok(got == wanted and len(got) > 200, f"wedge {wedge}: {len(got)} files are those of the undisturbed run", sorted(p for p in got.keys() | wanted.keys() if got.get(p) != wanted.get(p)))
finish()

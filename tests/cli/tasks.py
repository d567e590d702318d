"""Tasks as JSON: a generic farm that runs each command after its dependencies completes the job. The requirements are true: with --device cpu
no task asks for a GPU."""
import json
import os
import shlex
import subprocess
import sys

from script import TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = os.path.join(TOP, "tests/restart/twelve.yaml")
SMALL = ["--set", "frames=1001-1004", "--set", "farm.block_frames=2", "--set", "farm.chunk_frames=2", "--set", "farm.meshes=true", "--set", "farm.still_every=0",
         "--set", "farm.turntable=0", "--set", "farm.cameras=[main]", "--set", "output.aov.cameras=[]"]
code, said = hoodoo("submit", JOB, "--to", "tasks", "--device", "cpu", "--out", "out", *SMALL)
farm = json.loads(said[said.index("{"):])
tasks = {t["name"]: t for t in farm["tasks"]}
ok(code == 0 and farm["format"] == 1 and os.path.exists("out/farm/job.yaml") and len(tasks) == farm["task_count"], "the tasks, and the job they read", said)
ok(all(set(t["after"]) <= set(tasks) for t in tasks.values()), "each waits for tasks that there are")
ok(not any(t["gpu"] for t in tasks.values()) and tasks["sim.1001-1002"]["memory_bytes"] > 5e7, "without a GPU none is asked for")
done, order = set(), []
while len(done) < len(tasks):
    ready = [t for t in tasks.values() if t["name"] not in done and set(t["after"]) <= done]
    if not ready:
        break
    # the last task first: only dependencies may matter
    t = ready[-1]
    run = subprocess.run(t["argv"], capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd="/")
    if run.returncode:
        ok(False, f"{t['name']} ends with 0", shlex.join(t["argv"]), run.stderr)
        break
    done.add(t["name"])
    order.append(t["name"])
ok(len(done) == len(tasks), f"all {len(tasks)} are run, one by one", order)
code, said = hoodoo("verify", "out")
ok(code == 0, "and the folder is whole", said)
ok(len(os.listdir("out/frames")) == 4 and os.path.exists("out/mesh/twelve.1003.usdc") and os.path.exists("out/aov/twelve.main.1003.exr"),
   "with frames, meshes, pictures")
code, said = hoodoo("submit", JOB, "--to", "tasks", "--out", "out", "--dry-run", *SMALL)
gpu = {t["name"]: t["gpu"] for t in json.loads(said[said.index("{"):])["tasks"]}
ok(code == 0 and gpu["sim.1001-1002"] and not any(v for k, v in gpu.items() if k.startswith("mesh")), "with any device simulations ask for one, and meshes do not", gpu)
code, said = hoodoo("plan", JOB, "--device", "none", "--json", *SMALL)
ok(code == 0 and all(t["argv"] for t in json.loads(said)["tasks"]), "plan --json has the commands", said)
for device, wanted in (("cpu", 0), ("slurm", 4)):
    code, said = hoodoo("submit", JOB, "--to", "slurm", "--device", device, "--out", "other", "--dry-run", *SMALL)
    ok(code == 0 and said.count("--gres=gpu:1") == wanted, f"Slurm with --device {device}: {wanted} jobs ask for a GPU", said)
    code, said = hoodoo("submit", JOB, "--to", "openjd", *(["--device", "cpu"] if device == "cpu" else []), "--out", "other", "--dry-run", *SMALL)
    amounts = [a["name"] for s in json.loads(said[said.index("{"):])["steps"] for a in s.get("hostRequirements", {}).get("amounts", [])]
    ok(code == 0 and amounts.count("amount.worker.gpu") == wanted and amounts.count("amount.worker.memory") == 4, f"OpenJD likewise, {device}", amounts)
ok(not os.path.exists("other"), "a dry run leaves nothing")
finish()

"""Tasks as JSON: a generic farm that runs each command after its dependencies completes the job. The requirements are those of the plan: with
--device cpu no task asks for a GPU."""
import json
import os
import shlex
import subprocess
import sys

from script import HOODOO, TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = os.path.join(TOP, "tests/restart/twelve.yaml")
SMALL = ["--set", "frames=1001-1004", "--set", "farm.block_frames=2", "--set", "farm.chunk_frames=2", "--set", "farm.meshes=true", "--set", "farm.still_every=0",
         "--set", "farm.turntable=0", "--set", "farm.cameras=[main]", "--set", "output.aov.cameras=[]"]
# A prologue that notes what it is given, for all tasks but meshes, whose binary is a link of another name.
os.symlink(HOODOO, "linked hoodoo")
LINK, NOTES = os.path.abspath("linked hoodoo"), os.path.abspath("notes")
HEAD = ["--set", f"farm.prologue=[sh, -c, 'echo \"$1 $2\" >>{NOTES}; exec \"$@\"', --]", "--set", "farm.derive.prologue=[env, A=b c]", "--set", "farm.derive.binary=" + LINK]
code, said = hoodoo("submit", JOB, "--to", "tasks", "--device", "cpu", "--out", "out", *SMALL, *HEAD)
farm = json.loads(said[said.index("{"):])
tasks = {t["name"]: t for t in farm["tasks"]}
ok(code == 0 and farm["format"] == 1 and os.path.exists("out/farm/job.yaml") and len(tasks) == farm["task_count"], "the tasks, and the job they read", said)
ok(all(set(t["after"]) <= set(tasks) for t in tasks.values()), "each waits for tasks that there are")
ok(not any(t["gpu"] for t in tasks.values()) and all(t["gpu_memory_bytes"] == 0 for t in tasks.values()), "with --device cpu no task requests a GPU")
ok(all(t["memory_bytes"] >= 1.19 * t["peak_bytes"] > 4e7 for t in tasks.values()), "memory is the planned peak and a fifth", {k: t["peak_bytes"] for k, t in tasks.items()})
ok(tasks["sim.1001-1002"]["environment"] == {"HOODOO_DISK_DELAY": "60", "OMP_NUM_THREADS": "4", "LP_NUM_THREADS": "4"} and tasks["sim.1001-1002"]["cpus"] == 4, "threads are the cores requested")
ok([t["name"] for t in tasks.values() if t["after_any"]] == ["end"], "only the end runs after failures too")
done, order = set(), []
while len(done) < len(tasks):
    ready = [t for t in tasks.values() if t["name"] not in done and set(t["after"]) <= done]
    if not ready:
        break
    # the last task first: only dependencies may matter
    t = ready[-1]
    run = subprocess.run(t["argv"], capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd="/", env={**os.environ, **t["environment"]})
    if run.returncode:
        ok(False, f"{t['name']} ends with 0", shlex.join(t["argv"]), run.stderr)
        break
    missing = [p for p in t["outputs"] if not os.path.exists(os.path.join(farm["folder"], p))]
    ok(not missing, f"{t['name']} makes the outputs it names, {len(t['outputs'])}", missing)
    done.add(t["name"])
    order.append(t["name"])
with open(NOTES) as file:
    noted = file.read().splitlines()
ok(sorted(noted) == sorted([f"{HOODOO} run"] * 2 + [f"{HOODOO} status"]), "the prologue is given the command", noted)
ok(all(t["argv"][:3] == ["env", "A=b c", LINK] for t in tasks.values() if t["kind"] == "derive"), "a kind's own prologue and binary replace the farm's")
ok(len(done) == len(tasks), f"all {len(tasks)} are run, one by one", order)
code, said = hoodoo("verify", "out")
ok(code == 0, "and the folder is whole", said)
ok(len(os.listdir("out/frames")) == 4 and os.path.exists("out/mesh/twelve.1003.usdc") and os.path.exists("out/aov/twelve.main.1003.exr"),
   "with frames, meshes, pictures")
code, said = hoodoo("submit", JOB, "--to", "tasks", "--out", "out", "--dry-run", *SMALL)
gpu = {t["name"]: t["gpu"] for t in json.loads(said[said.index("{"):])["tasks"]}
ok(code == 0 and gpu["sim.1001-1002"] and not any(v for k, v in gpu.items() if k.startswith("mesh")), "with any device simulations ask for one, and meshes do not", gpu)
code, said = hoodoo("plan", JOB, "--device", "none", "--json", *SMALL)
plan = json.loads(said)
ok(code == 0 and plan["format"] == 1 and all(t["argv"] and "environment" in t and "outputs" in t for t in plan["tasks"]), "plan --json has the same", said)
code, said = hoodoo("submit", JOB, "--to", "local", "--out", "out", "--dry-run", "--json", *SMALL)
ok(code == 0 and {t["name"] for t in json.loads(said)["tasks"]} == set(tasks), "and submit --dry-run --json", said)
ok(not any(t["time_limit_seconds"] for t in plan["tasks"] if t["name"].startswith("sim")), "without a frame time no limit is requested")
KEYS = ["--set", "farm.sim.sbatch=[--partition=long, '--comment=a b: c']", "--set", "farm.derive.cpus=3", "--set", "farm.derive.hours=1.5", "--set", "farm.derive.memory_GB=2"]
for device, wanted in (("cpu", 0), ("slurm", 4)):
    code, said = hoodoo("submit", JOB, "--to", "slurm", "--device", device, "--out", "other", "--dry-run", "--json", *SMALL, *KEYS, "--", "--qos=x", "--mail-type=END",
                        "--mail-user", "me")
    jobs = {j["name"]: shlex.split(j["command"]) for j in json.loads(said[said.index("{"):])["would_submit"]}
    ok(code == 0 and said.count("--gres=gpu:1") == wanted, f"Slurm with --device {device}: {wanted} jobs request a GPU", said)
    sim, mesh, end = (jobs[name] for name in ("sim.1001-1002", "mesh.1001-1002", "end"))
    ok("--cpus-per-task=" + ("4" if device == "cpu" else "2") in sim and "--partition=long" in sim and "--comment=a b: c" in sim and "--partition=long" not in mesh,
       "options of a kind are its own", sim)
    ok({"--cpus-per-task=3", "--time=90", "--mem=1908M"} <= set(mesh) and any(a.startswith("--mem=") for a in sim), "cores, memory and time of a kind", mesh)
    ok([name for name, argv in jobs.items() if "--mail-type=END" in argv] == ["end"] and end[end.index("--mail-user") + 1] == "me" and
       all("--qos=x" in argv for argv in jobs.values()) and not any("me" in argv for argv in (sim, mesh)), "mail for the whole job, all else for every task", jobs)
    ok(any(a.startswith("--dependency=afterany:") for a in end) and not any(a.startswith("--time") for a in sim), "the end runs after any outcome", end)
    code, said = hoodoo("submit", JOB, "--to", "openjd", *(["--device", "cpu"] if device == "cpu" else []), "--out", "other", "--dry-run", *SMALL)
    steps = json.loads(said[said.index("{"):])["steps"]
    amounts = [a["name"] for s in steps for a in s["hostRequirements"]["amounts"]]
    ok(code == 0 and amounts.count("amount.worker.gpu") == wanted and amounts.count("amount.worker.memory") == amounts.count("amount.worker.vcpu") == len(steps) == 6,
       f"OpenJD likewise, {device}", amounts)
code, said = hoodoo("submit", JOB, "--to", "slurm", "--out", "out", "--dry-run", "--json", *SMALL, "--set", "frames=1001-1006")
ok(code == 0 and "--time=" in said, "frame times in the folder give a time limit", said)
code, said = hoodoo("submit", JOB, "--to", "openjd", "--out", "other", "--dry-run", *SMALL, *HEAD)
run = [s["script"]["actions"]["onRun"] for s in json.loads(said[said.index("{"):])["steps"]]
ok(code == 0 and {(r["command"], r["args"][1 if r["command"] == "env" else 3]) for r in run} == {("sh", "{{Param.Hoodoo}}"), ("env", LINK)}, "OpenJD has prologue and binary", run)
code, said = hoodoo("submit", JOB, "--to", "slurm", "--device", "cpu", "--out", "other", "--dry-run", *SMALL, "--set", "farm.prologue=[" + ", ".join("a" * 44) + "]")
ok(code == 2 and "at most 43" in said, "a prologue too long is refused", said)
code, said = hoodoo("submit", JOB, "--to", "openjd", "--out", "other", "--dry-run", *SMALL, "--set", "farm.sim.prologue=['{{Param.OutDir}}']")
ok(code == 2 and "'{{'" in said, "OpenJD's braces are refused", said)
# Cost.
code, said = hoodoo("plan", JOB, "--device", "cpu", "--out", "out", "--json", *SMALL, "--set", "farm.meshes=false", "--set", "farm.cameras=[]", "--nodes", "1,2",
                    "--price", "3600/h", "--rehearse", "1")
plan = json.loads(said)
one, two = plan["nodes"]
seconds = {t["name"]: t["estimated_seconds"] for t in plan["tasks"]}
ok(code == 0 and plan["critical_path"] == ["sim.1001-1002", "sim.1003-1004", "end"] and one["nodes"] == 1 and two["used"] == 1, "a chain of blocks is the critical path", said)
ok(abs(one["cost"] - one["node_hours"] * 3600) <= 2 and abs(one["wall_seconds"] - plan["shortest_seconds"]) <= 1 and one["wall_seconds"] <= sum(seconds.values()) and
   one["busy_percent"] == 100, "its time, hours and cost are those of the chain", one)
code, said = hoodoo("plan", JOB, "--device", "none", *SMALL, "--nodes", "1,2")
ok(code == 2 and "the time of a frame is not known" in said, "without frame times there is no cost", said)
for bad in (["--nodes", "0"], ["--nodes", "1,"], ["--price", "2"], ["--nodes", "2", "--price", "x"]):
    code, said = hoodoo("plan", JOB, "--device", "none", *bad)
    ok(code == 2, f"{' '.join(bad)} is refused", said)
for bad in ("farm.prologue=[[a]]", "farm.sim.sbatch=[[a, b]]", "farm.on_done=[{a: b}]"):
    code, said = hoodoo("plan", JOB, "--device", "none", "--set", bad)
    ok(code == 2 and "not an argument" in said, f"{bad} is refused", said)
ok(not os.path.exists("other"), "a dry run leaves nothing")
finish()

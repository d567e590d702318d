"""A job on a Slurm of three nodes, two of which cannot run hoodoo: what it requests, one mail, the bad nodes excluded, cancel, retry, and the end hook
called once."""

import json
import os
import re
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "lib"))
from one_node import OneNode
from script import HOODOO, TOP, clear_meshes, finish, hoodoo, obstruct_meshes, ok

os.environ["LP_NUM_THREADS"] = "1"
os.environ["HOODOO_DISK_DELAY"] = "2"
FEW = "farm: {block_frames: 4, chunk_frames: 4, meshes: true, still_every: 0, turntable: 0, retries: 1, sim: {cpus: 1, hours: 1}, derive: {cpus: 1, hours: 0.5}"


def write(path, text):
    with open(path, "w") as f:
        f.write(text)


def read(path):
    if not os.path.exists(path):
        return ""
    with open(path) as f:
        return f.read()


def queued(slurm):
    return [line for line in slurm.ask("squeue", "--noheader", "--array", "--format=%j %T").splitlines() if not line.startswith("stranger")]


def task(out, name):
    code, said = hoodoo("status", out, "--json")
    return {t["task"]: t for t in json.loads(said)["tasks"]}.get(name)


def frames(root):
    return len([n for n in os.listdir(root + "/frames") if n.endswith(".json")]) if os.path.isdir(root + "/frames") else 0


job = read(os.path.join(TOP, "tests/restart/twelve.yaml")).replace("spacing_m: 0.5", "spacing_m: 0.25").replace("every: 3", "every: 1")
write("hook.sh", "#!/bin/sh\necho \"$HOODOO_STATE $HOODOO_TASKS_DONE/$HOODOO_TASKS $1\" >>'" + os.path.abspath("hook.log") + "'\n")
write("mail.sh", "#!/bin/sh\necho \"$@\" >>'" + os.path.abspath("mail.log") + "'\ncat >/dev/null\n")
for script in ("hook.sh", "mail.sh"):
    os.chmod(script, 0o755)
write("job.yaml", job + FEW + ", binary: " + os.path.abspath("apps/hoodoo") + ", on_done: [" + os.path.abspath("hook.sh") + ", 'with: a space']}\n")
out = os.path.abspath("out")
# hoodoo is in apps (farm.binary). On node a, /dev/null is in its place (exit 126), and node b has nothing in apps (127). A node's own view
# of the disk is a mount namespace.
apps = os.path.abspath("apps")
os.mkdir(apps)
shutil.copy(HOODOO, apps)
broken = ("unshare", "--mount", "sh", "-c", 'mount --bind /dev/null "$0" && exec "$@"', apps + "/hoodoo")
bare = ("unshare", "--mount", "sh", "-c", 'mount -t tmpfs none "$0" && exec "$@"', apps)
with OneNode(requeue_exit=False, nodes=("a", "b", "c"), wrapped={"a": broken, "b": bare}, mail=os.path.abspath("mail.sh")) as slurm:
    stranger = slurm.ask("sbatch", "--parsable", "--job-name=stranger", "--hold", "--wrap", "true").strip()
    code, said = hoodoo("submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", out, "--", "--mail-type=END", "--mail-user=me")
    if not ok(code == 0, "a job is submitted", said):
        finish()
    with open(out + "/farm/slurm.json") as f:
        ids = {row["task"]: row["job"] for row in json.load(f)["tasks"]}
    shown = slurm.ask("scontrol", "show", "job", ids["sim.1001-1004"])
    code, said = hoodoo("plan", "job.yaml", "--device", "cpu", "--rehearse", "0", "--json")
    need = next(t for t in json.loads(said)["tasks"] if t["name"] == "sim.1001-1004")["memory_bytes"]
    ok("TimeLimit=01:00:00" in shown and "CPUs/Task=1" in shown and f"MinMemoryNode={-(-need // 2**20)}M" in shown and "gres" not in shown.lower(),
       "Slurm was asked for the planned memory, a core, an hour and no GPU", shown)

    slurm.wait_for(lambda: frames(out) >= 1, "a frame", 300)
    log = read(out + "/log/farm/sim.1001-1004.log")
    tries = read(out + "/log/farm/sim.1001-1004.jsonl")
    if '"node": "a"' in tries:
        ok('"exit": 126' in tries and '"excluded", "node": "a"' in tries and "on a: exit 126: this node cannot run" in log and "without a" in log,
           "a node that cannot run hoodoo is excluded, and the log says so", log, tries)
        ok('"exit": 127' in tries and '"excluded", "node": "b"' in tries and "on b: exit 127: this node cannot run" in log and "without a,b" in log,
           "and one that does not have it", log, tries)
        ok("ExcNodeList=a,b" in slurm.ask("scontrol", "show", "job", ids["sim.1001-1004"]), "and Slurm knows it")
        t = task(out, "sim.1001-1004")
        ok(t["state"] == "running" and t["tries"] == 3 and t["exit"] == "127" and "has no such program" in t["meaning"] and t["node"] == "c" and t["excluded_nodes"] == "a,b" and
           t["log"] == "log/farm/sim.1001-1004.log", "status has tries, exit code, its meaning and the node", t)
    else:
        ok(False, "the first task begins on node a", tries)

    code, said = hoodoo("cancel", out, "--json")
    names = set(json.loads(said)["cancelled"])
    ok(code == 0 and {"sim.1001-1004", "sim.1009-1012", "end"} <= names, "cancel names the tasks", said)
    slurm.wait_for(lambda: not queued(slurm), "an empty queue", 120)
    ok(slurm.ask("squeue", "--noheader", "--jobs=" + stranger, "--format=%T").strip() == "PENDING", "and leaves another user's job")
    ok(task(out, "sim.1009-1012")["state"] == "cancelled" and not os.path.exists("hook.log"), "status says so, and the hook was not called")
    code, said = hoodoo("cancel", out, "--json")
    ok(code == 0 and json.loads(said)["cancelled"] == [], "there is nothing left to cancel", said)

    # One task and those behind it; the meshes fail, for folders are in the place of their files.
    before = frames(out)
    obstruct_meshes(out, "twelve", range(1001, 1013))
    code, said = hoodoo("retry", out, "sim.1005-1008", "--json")
    ok(code == 2 and "waits for sim.1001-1004" in said, "a task whose prerequisites are missing is not retried", said)
    code, said = hoodoo("retry", out, "sim.1001-1004", "--json")
    chosen = {j["name"] for j in json.loads(said[said.index("{"):])["submitted"]} if code == 0 else said
    ok(code == 0 and {"sim.1001-1004", "sim.1009-1012", "mesh.1001-1004", "end"} <= chosen, "retry submits the task and those behind it", said)
    code, said = hoodoo("retry", out, "sim.1001-1004")
    ok(code == 2 and "waits or runs" in said, "and not twice", said)
    slurm.wait_for(lambda: not queued(slurm), "an empty queue", 600)
    t = task(out, "mesh.1001-1004")
    ok(frames(out) == 12 and t["tries"] == 2 + len([n for n in t["excluded_nodes"].split(",") if n]) and t["exit"] == "4" and t["meaning"] == "output cannot be written" and t["node"], "tasks that fail are tried twice", t)
    ok(read("hook.log") == "failed 3/6 with: a space\n", "the hook is told of the failure, once", read("hook.log"))
    clear_meshes(out)
    code, said = hoodoo("retry", out)
    ok(code == 0 and len(re.findall(r"job [0-9]+", said)) == 4, "retry without a task submits what is missing", said)
    slurm.wait_for(lambda: not queued(slurm), "an empty queue", 300)
    code, said = hoodoo("status", out)
    ok(code == 0 and re.search(r"tasks +none", said), "in the end all is done", said)
    for _ in range(2):
        hoodoo("retry", out)
        slurm.wait_for(lambda: not queued(slurm), "an empty queue", 120)
    ok(read("hook.log") == "failed 3/6 with: a space\ndone 6/6 with: a space\n", "the hook is called once for the end", read("hook.log"))
    mails = read("mail.log").splitlines()
    ok(len(mails) == 2 and all("base.end" in m or ".end" in m for m in mails), "one mail for each submission that ended", mails)

# Where no node can run hoodoo, the job fails instead of being pending for ever; one that the user excluded is not waited for.
os.mkdir("stranded")
os.chdir("stranded")
with OneNode(requeue_exit=False, nodes=("a", "b", "c"), wrapped={"a": broken, "b": bare}) as slurm:
    out = os.path.abspath("out")
    code, said = hoodoo("submit", "../job.yaml", "--to", "slurm", "--device", "cpu", "--out", out, "--", "--exclude=c")
    ok(code == 0, "a job for nodes that cannot run hoodoo", said)
    slurm.wait_for(lambda: not queued(slurm), "an empty queue", 300)
    t, behind = task(out, "sim.1001-1004"), task(out, "sim.1005-1008")
    log = read(out + "/log/farm/sim.1001-1004.log")
    ok(t["exit"] in ("126", "127") and t["tries"] == 2 and sorted(t["excluded_nodes"].split(",")) == ["a", "b"] and t["reason"].startswith("no node of its partition can run it"),
       "status says that no node is left", t)
    ok("exit 12" in log and "every node of partition farm is excluded (" in log and "(a,b could not" in log.replace("b,a", "a,b"), "and so does the log", log)
    ok(behind["tries"] == 0 and behind["state"] == "cancelled", "and what waits for it does not start", behind)
finish()

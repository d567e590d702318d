"""A job handed to a real Slurm, whose blocks are requeued, signalled, killed and failed on the way: in the end, the bytes of an
undisturbed run, and no frame simulated more often than its kills explain."""

import os
import re
import signal
import subprocess
import sys
import threading
import time

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "lib"))
from one_node import OneNode
from script import HOODOO, TOP, clear_meshes, finish, obstruct_meshes, of_a_run, ok, tree

os.environ["LP_NUM_THREADS"] = "1"


def hoodoo(*words):
    return subprocess.run([HOODOO, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True)


def write_job(path, wedges):
    with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as f:
        text = f.read()
    text += "farm: {block_frames: 4, chunk_frames: 2, meshes: true, still_every: 3, turntable: 4, sim: {cpus: 1}}\n"
    if wedges:
        text += "wedge: {over: [{key: seed, values: [3, 4]}, {key: wind.abrasion, values: [0.55, 0.7]}]}\n"
    with open(path, "w") as f:
        f.write(text.replace("spacing_m: 0.5", "spacing_m: 0.25").replace("every: 3", "every: 1"))


def queue(ask):
    """{id: (state, name)}"""
    rows = (line.split(" ", 2) for line in ask("squeue", "--noheader", "--array", "--format=%i %T %j").splitlines())
    return {row[0]: (row[1], row[2]) for row in rows}


def process_of(*words):
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/cmdline", "rb") as f:
                argv = f.read().decode(errors="replace").split("\0")
        except OSError:
            continue
        if argv[0] == HOODOO and all(word in argv for word in words):
            return int(pid)
    return 0


def frames(root, name):
    return len([n for n in os.listdir(f"{root}/frames") if n.startswith(name) and n.endswith(".json")]) if os.path.isdir(f"{root}/frames") else 0


def simulated(root):
    """{frame: how often}, as the run's own log says."""
    times = {}
    with open(f"{root}/log/run.log") as f:
        for line in f:
            said = re.search(r" frame (\d+), \d+/", line)
            if said:
                times[int(said[1])] = times.get(int(said[1]), 0) + 1
    return times


def job_id(out, task):
    with open(f"{out}/farm/slurm.json") as f:
        return re.search(r'"task": "%s",\s*"job": "([0-9_]+)"' % re.escape(task), f.read())[1]


def mend(tries, root):
    """Takes the obstacle away once a try has failed."""
    while not os.path.exists(tries) or '"exit": 4' not in open(tries).read():
        time.sleep(0.05)
    clear_meshes(root)


def whole_job():
    write_job("job.yaml", wedges=True)
    with OneNode(requeue_exit=False) as slurm:
        out = os.path.abspath("out dir %j $(touch pwned)")
        obstruct_meshes(out + "/w0001", "twelve_w0001", [1001])  # the first meshes fail
        done = hoodoo("submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", out)
        if not ok(done.returncode == 0, "a job of two wedges is submitted", done.stdout):
            return
        log = f"{out}/log/farm/w0001.mesh.1001-1002.log"
        mender = threading.Thread(target=mend, args=(log.replace(".log", ".jsonl"), out + "/w0001"), daemon=True)
        mender.start()
        again = hoodoo("submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", out)
        ok(again.returncode == 0 and re.search(r"queued already +40", again.stdout), "submitting again submits nothing twice", again.stdout)

        # One block is requeued, one signalled, one killed, each after it has made a frame.
        slurm.wait_for(lambda: frames(out + "/w0001", "twelve") >= 1, "a frame", 90)
        slurm.ask("scontrol", "requeue", job_id(out, "w0001.sim.1001-1004"))
        slurm.wait_for(lambda: frames(out + "/w0002", "twelve") >= 1, "a frame", 90)
        slurm.ask("scancel", "--signal=USR1", "--batch", job_id(out, "w0002.sim.1001-1004"))
        said = hoodoo("status", out)
        ok(said.returncode == 0 and "w0002.sim.1009-1012" in said.stdout and "Dependency" in said.stdout,
           "status knows what waits, and for what", said.stdout)
        slurm.wait_for(lambda: frames(out + "/w0002", "twelve") >= 5, "a frame of a second block", 200)
        pid = process_of("run", "--wedge=2", "--frames=1005-1008")
        ok(pid > 0, "a block runs as one process of its own")
        if pid:
            os.kill(pid, signal.SIGKILL)
        mender.join(200)
        ok(not mender.is_alive(), "meshes fail once")
        slurm.wait_for(lambda: not queue(slurm.ask), "an empty queue", 420)
        said = hoodoo("status", out)
        ok(said.returncode == 0 and re.search(r"tasks +none", said.stdout), "in the end all tasks are done", said.stdout,
           "\n".join(open(f"{out}/log/farm/{n}").read()[-700:] for n in sorted(os.listdir(out + "/log/farm")) if n.endswith(".log")))
        more = hoodoo("submit", "job.yaml", "--to", "slurm", "--device", "cpu", "--out", out)
        ok(more.returncode == 0 and not queue(slurm.ask), "and nothing is left to submit", more.stdout)

    ok(not os.path.exists("pwned") and not any("pwned" == n for _, _, names in os.walk(".") for n in names), "no path was taken for a command")
    for wedge in (1, 2):
        root, alone = f"{out}/w000{wedge}", f"alone{wedge}"
        hoodoo("run", "job.yaml", f"--wedge={wedge}", "--device", "cpu", "--out", alone, "--progress", "none")
        hoodoo("mesh", alone)
        here, there = tree(root, of_a_run), tree(alone, of_a_run)
        different = sorted(p for p in here.keys() | there.keys() if here.get(p) != there.get(p))
        ok(not different and len(here) > 60, f"wedge {wedge}: the files of an undisturbed run, byte for byte", different)
        times = simulated(root)
        often = {f: n for f, n in times.items() if n > 1}
        ok(sorted(times) == list(range(1001, 1013)) and (not often if wedge == 1 else set(often) <= set(range(1005, 1009)) and all(n == 2 for n in often.values())),
           f"wedge {wedge}: every frame written once, or once more where it was killed", times)
        ok(hoodoo("verify", root).returncode == 0, f"wedge {wedge}: verifies")
        for name in (f"twelve_w000{wedge}.contact.png", f"twelve_w000{wedge}.turntable.mp4", f"preview/twelve_w000{wedge}.1012.png"):
            ok(os.path.exists(f"{root}/{name}"), f"wedge {wedge}: {name.split('.', 1)[1]}")
    ok(os.path.exists(out + "/twelve.wedges.png"), "a sheet across the wedges")
    with open(f"{out}/log/farm/w0001.sim.1001-1004.log") as f:
        text = f.read()
    ok(text.count("hoodoo farm: ") >= 4 and "start 1" in text and "start 2" in text and "\r" not in text, "the log has both starts", text)


def where_the_site_requeues():
    write_job("small.yaml", wedges=False)
    with OneNode(requeue_exit=True) as slurm:
        out = os.path.abspath("small")
        done = hoodoo("submit", "small.yaml", "--to", "slurm", "--device", "cpu", "--out", out, "--set", "farm.turntable=0",
                      "--set", "farm.still_every=0", "--set", "farm.meshes=false", "--set", "farm.block_frames=6", "--", "--partition=farm")
        ok(done.returncode == 0, "a job without wedges, with more words for sbatch", done.stdout)
        slurm.wait_for(lambda: frames(out, "twelve") >= 2, "frames", 90)
        slurm.ask("scancel", "--signal=USR1", "--batch", job_id(out, "sim.1001-1006"))
        slurm.wait_for(lambda: not queue(slurm.ask), "an empty queue", 240)
        ok(frames(out, "twelve") == 12 and all(n == 1 for n in simulated(out).values()), "with RequeueExit=85 a stopped block goes on too",
           open(f"{out}/log/farm/sim.1001-1006.log").read())
        # A block that is wrong for good takes those after it away, and says why.
        out = os.path.abspath("wrong")
        done = hoodoo("submit", "small.yaml", "--to", "slurm", "--device", "9", "--out", out, "--set", "farm.turntable=0",
                      "--set", "farm.still_every=0", "--set", "farm.meshes=false", "--set", "farm.block_frames=6", "--set", "farm.retries=0")
        slurm.wait_for(lambda: not queue(slurm.ask), "an empty queue", 120)
        with open(f"{out}/log/farm/sim.1001-1006.log") as f:
            text = f.read()
        said = hoodoo("status", out).stdout
        ok("--device 9: there is no such device" in text and "exit 6" in text, "a failure stands in the log with its cause", text)
        ok("sim.1007-1012" in said and re.search(r"tasks done +0", said), "and status shows what it takes along", said)


whole_job()
os.rename("slurm", "slurm.first") if os.path.isdir("slurm") else None
where_the_site_requeues()
finish()

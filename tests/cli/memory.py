"""`hoodoo plan` predicts the memory of a run within 10 %. A run without enough memory is refused before its first frame, within any control
group, and immediately if no memory is left."""
import json
import os
import re
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
import peak
from peak import HOODOO, check, compare

JOBS = os.path.join(os.environ["HOODOO_TOP"], "jobs")
compare("a cube of goblins", f"{JOBS}/goblin_cube.yaml", "1001-1004", ["domain.spacing_m=0.2"])
compare("an arch", f"{JOBS}/demo.yaml", "1001-1004", ["domain.spacing_m=1.5"])

# The surface of carved terrain is found on coarse stacks: tunnels and bridges count although the first frame does not have them.
words = [f"{JOBS}/arches_cave.yaml", "--set", "domain.spacing_m=1.5", "--set", "frames=1001-1020", "--set", "output.vdb.every=100", "--set", "output.aov.every=100"]
plan = json.loads(subprocess.run([HOODOO, "plan", *words, "--rehearse", "0", "--json"], stdout=subprocess.PIPE, check=True).stdout)
subprocess.run([HOODOO, "run", *words, "--out", "carved", "--progress", "none"], check=True, stderr=subprocess.DEVNULL)
first, last = (int(n) for n in re.findall(r"frame 10(?:01|20): (\d+) particles", open("carved/log/run.log").read()))
check(abs(plan["particles"] / last - 1) < 0.2 and last > 2 * first, f"carved terrain: {plan['particles']} particles planned, {first} in the first frame and {last} in the last")
shutil.rmtree("carved")

TINY = """hoodoo: 1
name: tiny
frames: 1-2
clock: {years_per_frame: 500}
domain: {size_m: [8, 8, 8], spacing_m: 1}
scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}
"""
with open("tiny.yaml", "w") as file:
    file.write(TINY)
with open("large.yaml", "w") as file:
    file.write(TINY.replace("[8, 8, 8], spacing_m: 1", "[60, 60, 60], spacing_m: 0.3").replace("[6, 6, 6]", "[58, 58, 50]"))


def refused(what, shell, text):
    """`shell` runs hoodoo, which must print one line with `text` and exit with 5 quickly."""
    start = time.monotonic()
    try:
        done = subprocess.run(["sh", "-c", shell, "sh", HOODOO], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        check(False, f"{what}: it hangs")
        return
    lines = done.stderr.splitlines()
    good = done.returncode == 5 and len(lines) == 1 and re.search(text, lines[0])
    check(good, f"{what} ({time.monotonic() - start:.1f} s)" + ("" if good else f": exit {done.returncode}: {done.stderr.strip()}"))


# No memory is left: a tmpfs mounted over the control groups says so.
FULL = """mount -t tmpfs tmpfs /sys/fs/cgroup && echo 8589934592 >/sys/fs/cgroup/memory.max &&
echo 8589934592 >/sys/fs/cgroup/memory.current && exec "$1" run tiny.yaml --out nothing --progress none"""
can_mount = os.geteuid() == 0 and subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "tmpfs", "/sys/fs/cgroup"],
                                                 capture_output=True).returncode == 0
if can_mount:
    refused("nothing is left", f"exec unshare -m sh -c '{FULL}' sh \"$1\"", r"0 MB are free; no domain\.spacing_m would fit$")
    check(not os.path.exists("nothing/frames") or not os.listdir("nothing/frames"), "no frame was begun")
else:
    print("ok nothing is left # skipped: no tmpfs can be mounted here")


LIMIT = 600_000_000
group = peak.make_group(LIMIT)
if group:
    try:
        enter = f"echo $$ >{group}/cgroup.procs && "
        plan = json.loads(subprocess.run(["sh", "-c", enter + 'exec "$1" plan large.yaml --rehearse 0 --json', "sh", HOODOO],
                                         stdout=subprocess.PIPE, check=True).stdout)
        check(0 < plan["host_free_bytes"] <= LIMIT and not plan["fits_in_memory"], f"a plan knows its control group's limit: {plan['host_free_bytes'] / 1e6:.0f} MB")
        refused("a run does not begin what its control group will end", enter + 'exec "$1" run large.yaml --out limited --progress none',
                r"domain\.spacing_m: [0-9.]+ would fit$")
        # Page cache of files that the group has read counts as free.
        with open("ballast", "wb") as file:
            file.write(b"\0" * 1_000_000)
        ballast = enter + 'dd if=/dev/zero of=ballast bs=1M count=300 conv=fsync 2>/dev/null; exec "$1" plan tiny.yaml --rehearse 0 --json'
        plan = json.loads(subprocess.run(["sh", "-c", ballast, "sh", HOODOO], stdout=subprocess.PIPE, check=True).stdout)
        check(plan["fits_in_memory"] and plan["host_free_bytes"] > LIMIT / 2, f"page cache counts as free: {plan['host_free_bytes'] / 1e6:.0f} MB")
    finally:
        peak.end_group(group)
else:
    print("ok a control group's limit # skipped: no group can be made here")
shutil.rmtree("limited", ignore_errors=True)

# A group in which one frame fits but not two: each frame is written before the next is made.
words = [f"{JOBS}/arches_cave.yaml", "--set", "domain.spacing_m=0.75"]
plan = json.loads(subprocess.run([HOODOO, "plan", *words, "--rehearse", "0", "--json"], stdout=subprocess.PIPE, check=True).stdout)
group = peak.make_group(int(0.8 * sum(plan[part + "_bytes"] for part in ("device", "host", "process"))))
if group:
    code, said, most = peak.run(["run", *words, "--out", "turns", "--frames", "1001-1002", "--progress", "none"], group)
    peak.end_group(group)
    log = open("turns/log/run.log").read() if code == 0 else said.strip()
    check(code == 0 and ("memory holds one frame" in log or "frames are streamed" in log), f"two frames take turns: {most / 1e6:.0f} MB" + (f": {said}" if code else ""))
shutil.rmtree("turns", ignore_errors=True)

# The same with output.memory_GB, whatever the free memory; a limit below one frame is refused with the amount that would do.
both = [plan["host_bytes"], plan["host_bytes"] // 10]
said = subprocess.run([HOODOO, "run", *words, "--out", "turns", "--set", f"output.memory_GB={both[1] / 1e9:g}"], capture_output=True, text=True)
would = re.search(r"set output\.memory_GB to at least ([0-9.]+)", said.stderr)
check(said.returncode == 2 and would and not os.path.exists("turns/frames/arches_cave.1001.json"), f"too small a budget is refused: {said.stderr.strip()}")
budget = ["--set", f"output.memory_GB={would[1] if would else 1}"]
less = json.loads(subprocess.run([HOODOO, "plan", *words, *budget, "--rehearse", "0", "--json"], stdout=subprocess.PIPE, check=True).stdout)
check(less["frame_pace"] == "stream" and less["host_bytes"] <= float(budget[1].split("=")[1]) * 1e9 < both[0] and plan["frame_pace"] == "overlap",
      f"what it names will do: {less['host_bytes'] / 1e6:.0f} MB, streamed, in place of {both[0] / 1e6:.0f} MB")
code, said, most = peak.run(["run", *words, *budget, "--out", "turns", "--frames", "1001-1002", "--progress", "none"])
beside = most - plan["device_bytes"] - plan["process_bytes"]
check(code == 0 and "frames are streamed" in open("turns/log/run.log").read() and beside <= 1.15 * less["host_bytes"], f"and the run keeps to it: {beside / 1e6:.0f} MB beside device and process")
subprocess.run([HOODOO, "run", *words, "--out", "whole", "--frames", "1001-1002", "--progress", "none"], check=True)
files = [os.path.join(folder, name) for kind in ("points", "volumes", "aov", "rocks") for folder, _, names in os.walk(f"whole/{kind}") for name in names]
same = [open(f, "rb").read() == open(f.replace("whole", "turns", 1), "rb").read() for f in files]
check(len(files) > 8 and all(same), f"streamed frames are the same bytes: {len(files)} files")
shutil.rmtree("whole", ignore_errors=True)
shutil.rmtree("turns", ignore_errors=True)
sys.exit(peak.failed)

"""Compares planned and used memory. With a CPU device all memory is host memory, so the sum of the planned parts should equal the maximum resident
size of the process."""
import json
import os
import shutil
import subprocess
import time

HOODOO = os.environ["HOODOO"]
# Tolerances. In small runs most of the memory is the driver's own, which depends on whether its caches are warm.
SMALL, NEAR_SMALL, NEAR = 400e6, 0.15, 0.10
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what, flush=True)


def make_group(limit):
    """Creates a control group with a limit below our own and returns its folder, or None. Remove it with end_group()."""
    try:
        groups = dict(line.rstrip("\n").split(":", 2)[1:] for line in open("/proc/self/cgroup"))
        for controllers, group in groups.items():
            if "memory" in controllers.split(","):
                folder, name = "/sys/fs/cgroup/memory" + group.rstrip("/"), "memory.limit_in_bytes"
                break
        else:
            folder, name = "/sys/fs/cgroup" + groups[""].rstrip("/"), "memory.max"
        folder += f"/hoodoo_test_{os.getpid()}"
        os.mkdir(folder)
        try:
            with open(f"{folder}/{name}", "w") as file:
                file.write(str(limit))
        except OSError:
            os.rmdir(folder)
            raise
        return folder
    except OSError:
        return None


def end_group(group):
    """Removes the group, whose processes have ended or are about to."""
    for _ in range(100):
        try:
            os.rmdir(group)
            break
        except OSError:
            time.sleep(0.1)


def run(words, group=None):
    """Runs hoodoo, in a control group if one is given. Returns exit code, stderr and maximum resident size in bytes."""
    words = [HOODOO, *words]
    if group:
        words = ["sh", "-c", f'echo $$ >{group}/cgroup.procs && exec "$@"', "sh", *words]
    read, write = os.pipe()
    actions = [(os.POSIX_SPAWN_DUP2, write, 2), (os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    child = os.posix_spawnp(words[0], words, os.environ, file_actions=actions)
    os.close(write)
    with open(read) as pipe:
        said = pipe.read()
    _, code, use = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(code), said, use.ru_maxrss * 1024


def compare(name, job, frames, sets):
    """Runs these frames, several of them: memory is largest while one frame is written and the next is made."""
    words = [w for s in sets for w in ("--set", s)]
    plan = json.loads(subprocess.run([HOODOO, "plan", job, "--rehearse", "0", "--json", *words], stdout=subprocess.PIPE, check=True).stdout)
    parts = [plan[part + "_bytes"] for part in ("device", "host", "process")]
    code, said, peak = run(["run", job, "--out", "run", "--progress", "none", "--frames", frames, *words])
    shutil.rmtree("run", ignore_errors=True)
    ratio = sum(parts) / peak
    check(code == 0 and abs(ratio - 1) <= (NEAR_SMALL if sum(parts) < SMALL else NEAR),
          "{}: {:.0f} MB planned (device {:.0f}, host {:.0f}, process {:.0f}), {:.0f} MB at most: {:.3f}".format(
              name, sum(parts) / 1e6, *(p / 1e6 for p in parts), peak / 1e6, ratio) + (f": {said.strip()}" if code else ""))

"""Compares planned and used CPU time. With a CPU device this includes the time of the device."""
import json
import os
import shutil
import subprocess

HOODOO = os.environ["HOODOO"]
NEAR = 0.30  # tolerance
TRIES = 3  # other programs that share caches with only one of the two can disturb a comparison


def used(words):
    """Exit code and CPU seconds of one process."""
    child = os.posix_spawn(HOODOO, [HOODOO, *words], os.environ, file_actions=[(os.POSIX_SPAWN_OPEN, n, os.devnull, os.O_WRONLY, 0) for n in (1, 2)])
    _, code, use = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(code), use.ru_utime + use.ru_stime


def compare(name, job, sets, patience):
    """Is the plan within the tolerance? Also returns a line with the numbers."""
    words = [w for s in sets for w in ("--set", s)]
    for left in reversed(range(TRIES)):
        plan = json.loads(subprocess.run([HOODOO, "plan", job, "--json", "--rehearse", str(patience), "--out", "timed", *words],
                                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True).stdout)
        code, seconds = used(["run", job, "--out", "timed", "--progress", "none", *words])
        shutil.rmtree("timed", ignore_errors=True)
        planned = plan["estimated_cpu_seconds"]
        good = code == 0 and abs(planned / seconds - 1) <= NEAR
        if good or left == 0:
            break
    print("{} {}: {} s of CPU time planned ({}), {:.1f} s taken: {:.2f}".format("ok" if good else "not ok", name, planned, plan["estimated_from"],
                                                                             seconds, planned / seconds), flush=True)
    return good

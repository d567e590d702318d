"""The device is lost at some submission, or while one is waited for: exit code 6, no partial file, and the same command continues to the bytes of an
undisturbed run."""

import os
import random
import subprocess
import sys

sys.dont_write_bytecode = True
from script import *

SHIM = os.path.abspath("lost_device.so")
subprocess.run(["gcc", "-std=c11", "-D_GNU_SOURCE", "-O1", "-shared", "-fPIC", "-o", SHIM, TOP + "/tests/long/lib/lost_device.c", "-ldl"], check=True)
with open(TOP + "/tests/restart/twelve.yaml") as file:
    text = file.read().replace("frames: 1001-1012", "frames: 1001-1004").replace("every: 3", "every: 1")
with open("job.yaml", "w") as file:
    file.write(text)


def run(out, **environment):
    return ask(HOODOO, "run", "job.yaml", "--device", "cpu", "--out", out, "--progress", "none", env={**os.environ, **environment})


code, said = run("whole", LD_PRELOAD=SHIM, LOST_COUNT="count")
with open("count") as file:
    total = int(file.read())
wanted = tree("whole", of_a_run)
ok(code == 0 and total > 20, f"an undisturbed run, of {total} submissions", said)
draw = random.Random(3)
for late in (False, True):
    bad = []
    tries = [1, 2, total, *draw.sample(range(3, total), int(os.environ.get("HOODOO_LOST", 12)))]
    for at in tries:
        ask("rm", "-rf", "out")
        code, said = run("out", LD_PRELOAD=SHIM, LOST_AT=str(at), **({"LOST_LATE": "1"} if late else {}))
        left = [os.path.join(d, f) for d, _, names in os.walk("out") for f in names if ".tmp-" in f]
        if code != 6 or "VK_ERROR_DEVICE_LOST" not in said or "run the same command again" not in said or left or os.path.exists("out/lock"):
            bad.append(f"submission {at}: exit {code}, {left}: {said[-300:]}")
            continue
        code, said = run("out")
        got = tree("out", of_a_run)
        if code != 0 or got != wanted:
            bad.append(f"after submission {at}: exit {code}, {sorted(p for p in got.keys() | wanted.keys() if got.get(p) != wanted.get(p))}: {said[-300:]}")
    ok(not bad, f"lost {'while waiting for' if late else 'at'} {len(tries)} submissions: exit 6, and continued to the same bytes", "\n".join(bad))
finish()

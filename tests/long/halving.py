"""The demo's block at spacings that halve: particles, bricks of the field, memory, checkpoints and time grow with the rock's surface, and
not with its volume. Prints the table of tests/bench/memory.md. SPACINGS (m, "0.5 0.25 0.125"): others, coarse to fine."""
import json
import os
import re
import sys

sys.dont_write_bytecode = True
from script import HOODOO, TOP, finish, ok


def peak_of(argv):
    """Exit code, and MB resident at most, of a command by itself."""
    child = os.fork()
    if child == 0:
        os.execv(argv[0], argv)
    _, code, used = os.wait4(child, 0)
    return code, used.ru_maxrss / 1024


rows = []
for spacing in os.environ.get("SPACINGS", "0.5 0.25 0.125").split():
    out = f"at{spacing}"
    # A tenth of the demo's years a frame: no spacing is worn through in one.
    argv = [HOODOO, "run", os.path.join(TOP, "jobs/demo.yaml"), "--out", out, "--progress", "none", "--frames", "1001-1003", "--set",
            f"domain.spacing_m={spacing}", "--set", "clock.years_per_frame=92", "--set", "wind.flow.solver=uniform", "--set",
            "checkpoint.every=1", "--set", "output.vdb.points=surface"]
    code, peak = peak_of(argv)
    ok(code == 0, f"{spacing} m runs")
    with open(f"{out}/log/run.log") as file:
        born, deep, bricks, whole = map(int, re.findall(r"frame 1003: (\d+) particles, (\d+) voxels.*none yet, (\d+) of (\d+) bricks", file.read())[0])
    with open(f"{out}/log/timing.jsonl") as file:
        timing = json.loads(file.read())
    stress = sum(s["device_seconds"] for s in timing["stages"] if s["name"].startswith("stress"))
    kept = os.path.getsize(f"{out}/checkpoint/demo.1003.ckpt") / 1e6
    rows.append((float(spacing), born + deep, born, bricks, whole, peak, kept, (timing["wall_seconds"] - stress) / 3, stress / 3))
for a, b in zip(rows, rows[1:]):
    for at, what in ((2, "particles"), (3, "bricks"), (7, "time without stress")):
        ok(b[at] <= 5 * a[at], f"from {a[0]:g} to {b[0]:g} m: {b[at] / a[at]:.2f} times the {what}, where the rock has {b[1] / a[1]:.2f} times the voxels")
print("# | spacing (m) | voxels of rock | particles | bricks of the field | of | memory (MB) | checkpoint (MB) | a frame without stress (s) | its stress (s) |")
print("# |---|---|---|---|---|---|---|---|---|")
for r in rows:
    print(f"# | {r[0]:g} | {r[1]} | {r[2]} | {r[3]} | {r[4]} | {r[5]:.0f} | {r[6]:.1f} | {r[7]:.2f} | {r[8]:.2f} |")
finish()

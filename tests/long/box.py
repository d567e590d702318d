"""A scene that fills a twentieth of its box costs at most 1.1 times what it does in a tight one, in CPU time, in memory and in checkpoints (uniform
wind, no rain: air and catchments grow with the box), and is the same rock."""
import os
import shutil
import statistics
import sys

sys.dont_write_bytecode = True
from script import TOP, finish, ok

sys.path.insert(0, os.path.join(TOP, "tests/cli/lib"))
import peak

BOXES = {"tight": "[64, 24, 48]", "wide": "[130, 84, 67]"}
TURNS, MOST = 5, 1.1


def run(box):
    """CPU seconds, largest resident size, size of the checkpoint, and what the last points are."""
    before = os.times()
    code, said, most = peak.run(["run", os.path.join(TOP, "jobs/demo.yaml"), "--out", box, "--progress", "none", "--frames", "1001-1006", "--set",
                                 f"domain.size_m={BOXES[box]}", "--set", "wind.flow.solver=uniform", "--set", "checkpoint.every=5", "--set", "output.aov.every=5"])
    after = os.times()
    ok(code == 0, f"{box} runs", said if code else "")
    with open(f"{box}/frames/demo.1006.json") as file:
        ledger = file.read().split('"ledger"')[1].split("}")[0]
    kept = os.path.getsize(f"{box}/checkpoint/demo.1006.ckpt")
    shutil.rmtree(box)
    return after.children_user + after.children_system - before.children_user - before.children_system, most, kept, ledger


run("tight")  # compiles
seen = {box: [] for box in BOXES}
for _ in range(TURNS):
    for box in BOXES:
        seen[box].append(run(box))
for at, what in enumerate(("CPU time", "memory", "checkpoint")):
    tight, wide = (statistics.median(r[at] for r in seen[box]) for box in BOXES)
    ok(wide <= MOST * tight, f"{wide / tight:.3f} times the {what} ({tight:.4g}, {wide:.4g})")
ok(seen["tight"][0][3] == seen["wide"][0][3], "the same rock is left")
finish()

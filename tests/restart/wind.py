"""Flowing wind, whose state continues from frame to frame, gives the same bytes with other numbers of threads and in blocks."""

import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from twelve import *

FRAMES = "1001-1005"
FLOW = ("--set", f"frames={FRAMES}", "--set", "wind.flow.solver=sph", "--set", "wind.flow.spacing_m=2", "--set",
        "wind.flow.rock_change=0", "--set", "wind.turn_deg.1001=0", "--set", "wind.turn_deg.1005=40", "--set", "wind.flow.flushes=0.5", "--set", "erosion.max_step=1",
        "--set", "checkpoint.every=2")

code, said = run("whole", *FLOW)
whole = tree("whole")
log = "".join(open(os.path.join("whole/log", name), encoding="utf-8").read() for name in os.listdir("whole/log"))
runs = {line.split(": wind: ")[0].split()[-1] for line in log.splitlines() if ": wind: " in line}
ok(code == 0 and len(runs) == 4, "the flow runs on in every frame", said, log)
code, said = run("uniform", *FLOW, "--set", "wind.flow.solver=uniform")
ok(code == 0 and digest(manifest("uniform", 1005)) != whole["frames/twelve.1005.json"], "and is not the uniform wind", said)

for threads in ("0", "1", "2"):
    code, said = run(threads, *FLOW, env={"LP_NUM_THREADS": threads})
    ok(code == 0 and tree(threads) == whole, f"LP_NUM_THREADS={threads}: the same bytes", said)

for block in ("1001-1002", "1003-1003", "1004-1005"):
    code, said = run("blocks", *FLOW, "--frames", block)
    ok(code == 0, f"block {block}", said)
blocks = tree("blocks")
ok({k: v for k, v in blocks.items() if not k.startswith("checkpoint/")} == {k: v for k, v in whole.items() if not
   k.startswith("checkpoint/")}, "blocks in sequence are the whole", sorted(k for k in whole if blocks.get(k) != whole[k]))
ok(digest(checkpoint("blocks", 1005)) == digest(checkpoint("whole", 1005)), "and leave the same state")

code, said = run("steep", *FLOW, "--set", "wind.direction=[0, 0.1, -1]")
ok(code == 2 and len(errors(said)) == 1 and "wind.direction" in said, "a wind from above: 2, in one line", code, said)
code, said = run("fine", *FLOW, "--set", "wind.flow.spacing_m=0.01")
ok(code == 2 and len(errors(said)) == 1 and "wind.flow.spacing_m" in said, "more air than there is room for: 2, in one line", code, said)
finish()

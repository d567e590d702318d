"""The same job gives the same bytes when run twice, in blocks, and with other numbers of threads."""

import os
import shutil
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from twelve import *

truth = Truth()
frames = [path for path in truth.whole if path.startswith("frames/")]
ok(len(frames) == 12 and len(truth.whole) == 5 * 12 + 2 + 2 + 2 + 4,
   "a run leaves 12 frames of five files, 2 checkpoints, job.yaml, run.json, a USD stage in two files, and records of these four",
   sorted(truth.whole))
ok(len({truth.whole[path] for path in truth.whole if path.startswith("volumes/")}) == 12, "every frame differs from the others")
ok(len(truth.checkpoint) == 12, "checkpoint.every=1 keeps one of each frame", truth.checkpoint.keys())
code, said = run("again")
ok(code == 0 and tree("again") == truth.whole, "two runs, the same bytes", code, truth.differences("again"))
code, said = run("whole")
ok(code == 0 and "all 12 frames are done already" in said and tree("whole") == truth.whole, "a third into the first's folder has "
   "nothing to do", said)

for name, value in (("LP_NUM_THREADS", "0"), ("LP_NUM_THREADS", "1"), ("LP_NUM_THREADS", "2"), ("OMP_NUM_THREADS", "1"),
                    ("OMP_NUM_THREADS", "2"), ("OMP_NUM_THREADS", "5")):
    shutil.rmtree("again")
    code, said = run("again", env={name: value})
    ok(code == 0 and tree("again") == truth.whole, f"{name}={value}: the same bytes", said, truth.differences("again"))

code, said = run("late", "--frames", "1005-1008")
ok(code == CHECKPOINT and len(errors(said)) == 1 and "1005" in errors(said)[0], "a block without the one before it: 7, in one line",
   code, said)
for block in ("1001-1004", "1005-1008", "1009-1012"):
    code, said = run("blocks", "--frames", block)
    ok(code == 0, f"block {block}", said)
    if block == "1005-1008":
        ok(not os.path.exists(manifest("blocks", 1009)), "a block ends where it should")
ok(truth.differences("blocks") == "", "blocks in sequence are the whole", truth.differences("blocks"))
code, said = run("gap", "--frames", "1001-1004")
code, said = run("gap", "--frames", "1009-1012")
ok(code == 0 and not os.path.exists(manifest("gap", 1005)) and digest(manifest("gap", 1012)) == truth.whole["frames/twelve.1012.json"],
   "a block continues from any checkpoint before it and writes only its own frames", said)
code, said = run("gap", "--frames", "1005-1008")
ok(code == CHECKPOINT and len(errors(said)) == 1, "a block whose checkpoint is gone by now: 7, in one line", code, said)
code, said = run("gap")
ok(code == 0, "the whole job, with a gap in it", code, said)
ok(truth.differences("gap") == "", "fills the gap with the same bytes", truth.differences("gap"))
code, said = run("steps", "--frames", "1001-1012x3")
got = sorted(os.listdir("steps/frames"))
ok(code == 0 and got == [f"twelve.{f}.json" for f in range(1001, 1013, 3)] and
   all(digest(f"steps/frames/{name}") == truth.whole[f"frames/{name}"] for name in got), "every third frame: those, the same", said, got)

below = ("--set", "frames=-4-3")
run("below", *below)
for block in ("-4--1", "0-3"):
    code, said = run("below-blocks", *below, "--frames", block)
    ok(code == 0 and (block == "-4--1" or "checkpoint of frame -1" in said), f"frames below zero, block {block}", said)
ok(tree("below") == tree("below-blocks"), "frames below zero: blocks are the whole")
finish()

"""One writer per folder: a second run is refused and told the holder; the lock of a killed run is taken over and removed."""

import os
import signal
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from twelve import *

truth = Truth()
held = Held("out")
held.hold_at(1004)
before = tree("out")
for options in ((), ("--repair",), ("--resume", "never"), ("--frames", "1001-1002", "--repair")):
    code, said = run("out", *options)
    ok(code == OUTPUT and f"process {held.child.pid}" in said and "simulates frames 1001-1012" in said,
       f"a second run {' '.join(options)} is refused and told the holder", code, said)
now = tree("out")
ok({p: d for p, d in before.items() if p in now and p != "lock"} == {p: d for p, d in now.items() if p in before and p != "lock"} and
   before.keys() <= now.keys(), "and has changed nothing")
code, said = run("out", "--frames", "1001-1002")
ok(code == 0 and "all 2 frames are done" in said, "frames that are done can be asked for beside it", code, said)
held.kill(signal.SIGKILL)
held.end()
ok(os.path.exists("out/lock"), "a killed run leaves its lock")
code, said = run("out")
ok(code == 0 and "was left behind by process" in said and not os.path.exists("out/lock"), "which the next one takes over, and says so", code, said)
ok(truth.differences("out") == "", "to the same bytes", truth.differences("out"))
code, said = stop("out2", 1003, signal.SIGTERM)
ok(code == STOPPED and not os.path.exists("out2/lock"), "a run that was stopped leaves none", code, said)
finish()

"""A run stopped by a signal exits with 85 and a checkpoint of its last frame; run again, it ends with the same bytes."""

import os
import shutil
import signal
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from twelve import *

LONG = len(sys.argv) > 1  # every signal after every frame
truth = Truth()


def stop_and_go_on(frame, number, times=1):
    name = f"{signal.Signals(number).name}{' three times' if times > 1 else ''} after frame {frame}"
    shutil.rmtree("stopped", ignore_errors=True)
    code, said = stop("stopped", frame, number, times)
    kept = checkpoints("stopped")
    last = manifest("stopped", frame + 1)
    ok(code == STOPPED and len(errors(said)) == 1 and kept[-1:] == [frame] and not os.path.exists(last) and
       digest(checkpoint("stopped", frame)) == truth.checkpoint[frame], f"{name}: 85, in one line, with its checkpoint", code, kept, said)
    code, said = run("stopped")
    ok(code == 0 and truth.differences("stopped") == "", f"{name}: run again, the same bytes", code, truth.differences("stopped"), said)


# Below, consecutive runs are stopped after every frame.
for frame in range(FIRST, LAST) if LONG else (FIRST + 1, FIRST + 6, FIRST + 8, LAST - 1):
    stop_and_go_on(frame, signal.SIGTERM)
if LONG:
    for number in SIGNALS:
        for frame in range(FIRST, LAST):
            for times in (1, 3):
                stop_and_go_on(frame, number, times)
else:
    stop_and_go_on(1001, signal.SIGINT)
    stop_and_go_on(1007, signal.SIGINT, 3)
    stop_and_go_on(1006, signal.SIGUSR1)
    stop_and_go_on(1011, signal.SIGUSR2, 3)
    stop_and_go_on(1005, signal.SIGHUP)
    stop_and_go_on(1003, signal.SIGXCPU)
    stop_and_go_on(1004, signal.SIGTERM, 3)

shutil.rmtree("stopped")
code, said = stop("stopped", LAST, signal.SIGTERM)
ok(code == 0 and truth.differences("stopped") == "", "stopped after the last frame: nothing is left to do, so it is done", code, said)

shutil.rmtree("stopped")
codes = []
while len(codes) < 13 and (not codes or codes[-1] == STOPPED):
    held = Held("stopped")
    held.line_of("hoodoo: frame 1")
    held.kill(signal.SIGTERM)
    codes.append(held.end()[0])
ok(codes[-1] == 0 and truth.differences("stopped") == "", f"stopped again and again, {len(codes)} runs: it gets there, with the same "
   "bytes", codes, truth.differences("stopped"))
finish()

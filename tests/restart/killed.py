"""Runs killed by SIGKILL after frames and at random moments: the same command then gives the same bytes and leaves no partial files."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
import script
from twelve import *

SEED = int(os.environ.get("SEED", "1"))
LONG = len(sys.argv) > 1  # kill after every frame, and at so many random moments
MOMENTS = int(sys.argv[1]) if LONG else 3
truth = Truth()


def whole_frames(out):
    """Right after a kill, every existing manifest must match its files."""
    frames = [name for name in os.listdir(os.path.join(out, "frames")) if name.endswith(".json")] if os.path.isdir(
        os.path.join(out, "frames")) else []
    here = tree(out)
    for name in frames:
        number = name.split(".")[1]
        for path in truth.whole:
            if number in path and not path.startswith("checkpoint/") and here.get(path) != truth.whole[path]:
                return f"{path} is not whole though frame {number} counts as done"
    return ""


def go_on(name, notes=""):
    code, said = run("killed")
    return ok(code == 0 and truth.differences("killed") == "", name, code, truth.differences("killed"), notes, said)


# The first and the last frame, and frames right after a checkpoint and long after one.
for frame in range(FIRST, LAST + 1) if LONG else (FIRST, FIRST + 4, FIRST + 8, LAST):
    shutil.rmtree("killed", ignore_errors=True)
    held = Held("killed")
    held.hold_at(frame)
    held.kill(signal.SIGKILL)
    code, _ = held.end()
    bad = whole_frames("killed")
    ok(code == -signal.SIGKILL and bad == "" and os.path.exists(manifest("killed", frame)), f"killed after frame {frame}: it is whole", code, bad)
    go_on(f"killed after frame {frame}: run again, the same bytes")


def kill_in_write(folder, nth):
    """Kills the run when the nth temporary file is seen in the folder; False if the run ends first."""
    child = subprocess.Popen(command("killed"), stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    seen = set()
    while child.poll() is None and len(seen) < nth:
        try:
            seen.update(name for name in os.listdir(os.path.join("killed", folder)) if ".tmp-" in name)
        except FileNotFoundError:
            pass
    child.kill()
    return child.wait(PATIENCE) == -signal.SIGKILL


left = 0
for folder, nth in (("points", 2), ("volumes", 3), ("aov", 1), ("frames", 2), ("checkpoint", 2)):
    shutil.rmtree("killed")
    kill_in_write(folder, nth)
    left += any(".tmp-" in path for path in tree("killed"))
    bad = whole_frames("killed")
    ok(bad == "", f"killed while it wrote into {folder}: frames that count are whole", bad)
    go_on("and run again, the same bytes")
print(f"# {left} of 5 kills left a half-written file behind")


def kill_after(seconds):
    child = subprocess.Popen(command("killed"), stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    time.sleep(seconds)
    child.kill()
    return child.wait(PATIENCE)


# Random moments over the length of a run, each in the folder that the kill before has left; some fall into a write.
start = time.monotonic()
shutil.rmtree("killed")
run("killed")
length = time.monotonic() - start
moments = random.Random(SEED)
killed = temporary = 0
for i in range(MOMENTS):
    shutil.rmtree("killed")
    seconds = [moments.uniform(0, length) for _ in range(3)]
    for s in seconds:
        killed += kill_after(s) == -signal.SIGKILL
        temporary += any(".tmp-" in path for path in tree("killed")) if os.path.isdir("killed") else 0
        bad = whole_frames("killed") if os.path.isdir("killed") else ""
        if bad:
            break
    ok(bad == "", f"killed after {', '.join(f'{s:.3f}' for s in seconds)} s (seed {SEED}): frames that count are whole", bad)
    go_on("and run again, the same bytes")

# A small run of another model, killed again and again before it is let to its end.
with open("small.yaml", "w") as file:
    file.write(script.SMALL + "checkpoint: {every: 2, keep: 9}\n")


def small(out):
    return [HOODOO, "run", "small.yaml", "--device", "cpu", "--out", out, "--progress", "none"]


def files(out):
    return script.tree(out, lambda path: not path.startswith("log/"))


start = time.monotonic()
script.ask(*small("small_whole"))
length = time.monotonic() - start
whole, bad, small_kills = files("small_whole"), [], 0
for i in range(140 if LONG else 14):
    shutil.rmtree("small", ignore_errors=True)
    for s in [moments.uniform(0, length) for _ in range(3)]:
        child = subprocess.Popen(small("small"), stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        time.sleep(s)
        child.kill()
        child.wait(PATIENCE)
        small_kills += 1
    code, said = script.ask(*small("small"))
    if code != 0 or files("small") != whole:
        bad.append(f"{i}: exit {code}: {said[-300:]}")
ok(not bad, f"a small run killed {small_kills} times, three times before each end: the same bytes", "\n".join(bad))
fault("runs killed by SIGKILL: after frames, in writes, at random moments", (LAST - FIRST + 1 if LONG else 4) + 5 + 3 * MOMENTS + small_kills,
      "every frame with a manifest is whole; the same command ends with the same bytes")
print(f"# {killed} of {3 * MOMENTS} runs were killed before their end, {temporary} while they wrote a file")
finish()

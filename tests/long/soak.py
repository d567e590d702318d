"""A long run on the local farm whose processes are killed at random for SOAK_MINUTES (30): a thousand small frames in blocks, of which each try
ends in a kill until the time is over. Memory of a process does not grow with its frames, no file is left over, and the files are those of an
undisturbed run."""

import os
import random
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from script import *

MINUTES = float(os.environ.get("SOAK_MINUTES", "30"))
FRAMES = int(os.environ.get("SOAK_FRAMES", "1000"))
draw = random.Random(int(os.environ.get("SEED", "1")))
with open("soak.yaml", "w") as file:
    file.write(f"""hoodoo: 1
name: soak
frames: 1-{FRAMES}
clock: {{years_per_frame: 20}}
domain: {{size_m: [10, 10, 8], spacing_m: 0.5}}
scene: {{union: [{{box: {{min_m: [2, 2, 3], max_m: [8, 8, 6]}}}}, {{box: {{min_m: [3, 3, 0], max_m: [7, 7, 3], inert: true}}}}]}}
strata: [{{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.01, interlock_MPa: 0.2}}]
rain: {{m_per_yr: 0.3}}
deposition: {{viability: 0.5}}
checkpoint: {{every: 25, keep: 2}}
farm: {{block_frames: 250, still_every: 0, turntable: 0, retries: 100}}
""")


def of_frames(path):
    return path.startswith(("points", "volumes", "frames", "soak.usda"))


def resident(pid):
    with open(f"/proc/{pid}/statm") as file:
        return int(file.read().split()[1]) * 4096


def children(pid):
    found = ask("pgrep", "-P", str(pid))[1].split()
    return [int(p) for p in found] + [q for p in found for q in children(p)]


# An undisturbed run, whose memory is measured at its first and last hundredth frames.
child = subprocess.Popen([HOODOO, "run", "soak.yaml", "--device", "cpu", "--out", "whole", "--progress", "none"], stderr=subprocess.DEVNULL)
memory = {}
while child.poll() is None:
    time.sleep(0.2)
    try:
        done = len(os.listdir("whole/frames"))
        memory.setdefault(done * 10 // FRAMES, []).append(resident(child.pid))
    except (FileNotFoundError, ProcessLookupError, IndexError):
        pass
ok(child.returncode == 0, "an undisturbed run", child.returncode)
tenth = {t: sorted(m)[len(m) // 2] for t, m in memory.items()}
# Kernels of things that happen later, as the first block that falls, are compiled into the process in the first half.
early, late = tenth[5], tenth[9]
ok(abs(late - early) <= 0.02 * early, f"resident at half and at the end of {FRAMES} frames: {early / 1e6:.1f} and {late / 1e6:.1f} MB", tenth)
whole = tree("whole", of_frames)

end, kills, tries = time.monotonic() + 60 * MINUTES, 0, 0
while True:
    farm = subprocess.Popen([HOODOO, "submit", "soak.yaml", "--to", "local", "--workers", "2", "--device", "cpu", "--out", "out"],
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    tries += 1
    while farm.poll() is None and time.monotonic() < end:
        time.sleep(draw.uniform(0.5, 8))
        victims = children(farm.pid) + ([farm.pid] if draw.random() < 0.1 else [])
        if victims:
            try:
                os.kill(draw.choice(victims), draw.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM)))
                kills += 1
            except ProcessLookupError:
                pass
    said = farm.communicate()[1]
    if time.monotonic() >= end or farm.returncode == 0:
        if farm.returncode == 0 and time.monotonic() < end:
            ask("rm", "-rf", "out")  # once more from the start
            continue
        break
code, said = hoodoo("submit", "soak.yaml", "--to", "local", "--workers", "2", "--device", "cpu", "--out", "out", timeout=3600)
got = tree("out", of_frames)
ok(code == 0 and got == whole, f"after {kills} kills in {MINUTES:g} minutes and {tries} submissions: the same bytes",
   sorted(p for p in {*got, *whole} if got.get(p) != whole.get(p))[:20], said[-600:])
left = [os.path.join(at, name) for at, _, names in os.walk("out") for name in names if ".tmp-" in name or name == "lock"]
ok(not left, "no file is left over", left)
ok(hoodoo("verify", "out")[0] == 0, "verify finds all sound")
finish()

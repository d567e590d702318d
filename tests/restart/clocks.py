"""Two machines and one folder: the second is refused while the first lives, also if the first one's clock is set back by an hour, or if the disk has
no hard links; and a machine that slept, and whose folder another took over, writes nothing more."""

import json
import os
import re
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from script import *

SHIM = os.path.abspath("other_machine.so")
subprocess.run(["gcc", "-std=c11", "-D_GNU_SOURCE", "-O1", "-shared", "-fPIC", "-o", SHIM, TOP + "/tests/restart/lib/other_machine.c"], check=True)
with open("long.yaml", "w") as file:
    file.write("hoodoo: 1\nname: long\nframes: 1-20000\nclock: {years_per_frame: 5}\ndomain: {size_m: [24, 24, 24], spacing_m: 2}\n"
               "scene: {box: {min_m: [4, 4, 0], max_m: [20, 20, 16]}}\ncheckpoint: {every: 1000}\noutput: {vdb: {every: 1000}}\n")
ELSEWHERE = ["unshare", "--uts", "--pid", "--fork", "--mount-proc", "sh", "-c", 'hostname elsewhere && exec "$@"', "--"]


def first(out, **environment):
    run = subprocess.Popen([HOODOO, "run", "long.yaml", "--device", "cpu", "--out", out, "--progress", "none"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                           env={**os.environ, "LD_PRELOAD": SHIM, "OMP_NUM_THREADS": "1", "LP_NUM_THREADS": "1", **environment})
    end = time.monotonic() + 60
    while not (os.path.exists(out + "/lock") and os.path.exists(out + "/frames") and os.listdir(out + "/frames")) and time.monotonic() < end:
        time.sleep(0.1)
    return run


def second(out, **environment):
    return ask(*ELSEWHERE, HOODOO, "run", "long.yaml", "--device", "cpu", "--out", out, "--progress", "none", env={**os.environ, **environment}, timeout=120)


if ask(*ELSEWHERE, "true")[0] != 0:
    print("ok two machines # skip namespaces are not allowed here (unshare)")
    sys.exit(0)
run = first("back", CLOCK_AHEAD="3600")
time.sleep(4)  # the clock is set back meanwhile
code, said = second("back")
ok(run.poll() is None and code == 4 and "simulates frames 1-20000" in said, "the other machine is refused while the clock of the first was set back", code, said)
run.send_signal(signal.SIGTERM)
ok(run.wait(60) == 85, "and the first saves and stops as usual", run.stdout.read())

run = first("bare", NO_LINKS="1")
code, said = second("bare", NO_LINKS="1", LD_PRELOAD=SHIM)
ok(run.poll() is None and code == 4 and "simulates frames 1-20000" in said, "without hard links likewise", code, said)
code, said = ask(HOODOO, "run", "long.yaml", "--device", "cpu", "--out", "bare", "--progress", "none", env={**os.environ, "NO_LINKS": "1", "LD_PRELOAD": SHIM})
ok(code == 4 and f"process {run.pid} on" in said, "and on the same machine, at once", code, said)
run.kill()
run.wait()
code, said = ask(HOODOO, "run", "long.yaml", "--device", "cpu", "--out", "bare", "--frames", "1-3", "--progress", "none", env={**os.environ, "NO_LINKS": "1", "LD_PRELOAD": SHIM})
ok(code == 0 and not os.path.exists("bare/lock"), "the lock of a killed run is taken over there", code, said)

# The first sleeps with all its threads; meanwhile the folder becomes another's, as after 30 s of watching.
run = first("slept")
run.send_signal(signal.SIGSTOP)
time.sleep(11)  # longer than two heartbeats
with open("slept/lock") as file:
    text = file.read()
with open("slept/new", "w") as file:
    file.write(re.sub(r'"token": *"[^"]*"', '"token": "taken over"', text))
os.rename("slept/new", "slept/lock")
before = tree("slept", lambda path: not path.startswith(("log", "lock")) and ".tmp-" not in path)
run.send_signal(signal.SIGCONT)
said, _ = run.communicate(timeout=60)
after = tree("slept", lambda path: not path.startswith(("log", "lock")) and ".tmp-" not in path)
ok(run.returncode == 4 and "another process took over this folder" in said, "a run that slept notices that its folder is another's", run.returncode, said)
ok(before == after, "and has not replaced a file", sorted(p for p in before.keys() | after.keys() if before.get(p) != after.get(p)))
ok("taken over" in open("slept/lock").read(), "nor removed the other's lock")
finish()

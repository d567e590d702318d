"""The bar on terminals of 80 and 44 columns: it moves, fits in a line, and shows time to go and stage; at the end the place of the files is said."""

import fcntl
import json
import os
import pty
import re
import shutil
import signal
import struct
import subprocess
import sys
import termios
import time

from script import HOODOO, finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = {
    "hoodoo": 1, "name": "a", "frames": "1-4", "domain": {"size_m": [8, 8, 8], "spacing_m": 0.5}, "scene": {"box": {"min_m": [2, 2, 0], "max_m": [6, 6, 6]}},
    "strata": [{"interlock_MPa": 0.05}],
}


def on_terminal(columns, *words):
    """What hoodoo writes on a terminal of that width: the lines of the bar, and the others."""
    begin, wait = os.pipe()
    pid, terminal = pty.fork()
    if pid == 0:
        os.close(wait)
        os.read(begin, 1)  # until the terminal has its size
        os.execve(HOODOO, [HOODOO, *words], {**os.environ, "TERM": "xterm"})
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    os.close(wait)
    said = b""
    while True:
        try:
            part = os.read(terminal, 4096)
        except OSError:
            break
        if not part:
            break
        said += part
    status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    os.close(begin)
    lines = re.split("[\r\n]+", said.decode())
    return status, [line.replace("\033[K", "") for line in lines if line.startswith("[")], " ".join(line for line in lines if "hoodoo:" in line)


with open("job.json", "w") as file:
    json.dump(JOB, file)
for columns in (80, 44):
    out = f"out{columns}"
    code, bar, said = on_terminal(columns, "run", "job.json", "--out", out)
    meters = [line[1:line.index("]")].count("#") for line in bar]
    ok(code == 0 and len(set(meters)) >= 4 and meters == sorted(meters) and max(map(len, bar)) < columns, f"{columns} columns: it moves and fits in a line", bar)
    ok(any(re.search(r"1/4, \d+ s to go", line) for line in bar) and any(re.search(r"\d/4, \d+ s to go, [234] [a-z]+", line) for line in bar),
       f"{columns} columns: time to go and the stage", bar)
    ok(f"frames 1-4 are in {out}" in said, "the run says where its files are", said)
    code, bar, said = on_terminal(columns, "mesh", out)
    ok(code == 0 and any("2/4, mesh of frame 2" in line for line in bar) and f"meshes of 4 frames are in {out}/mesh" in said, "so does mesh, which counts", bar, said)

with open("out80/log/run.log") as file:
    ok(all(re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d[+-]\d{4} ", line) for line in file), "times in the log have their zone")

# Meshes stop as runs do, and are continued.
shutil.rmtree("out80/mesh")
child = subprocess.Popen([HOODOO, "mesh", "out80"], stderr=subprocess.PIPE, text=True)
until = time.time() + 60
while not os.path.isdir("out80/mesh") and time.time() < until:
    time.sleep(0.001)
child.send_signal(signal.SIGTERM)
said = child.communicate()[1]
ok(child.returncode == 85 and "with --missing" in said, "mesh stops at a signal: 85", child.returncode, said)
code, said = hoodoo("mesh", "out80", "--missing")
ok(code == 0 and sorted(os.listdir("out80/mesh")) == sorted(os.listdir("out44/mesh")), "and is continued", said, os.listdir("out80/mesh"))
finish()

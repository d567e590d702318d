"""A signal ends every verb with exit code 85: verbs without anything to save at once, the report after what it is writing."""
import fcntl
import os
import signal
import subprocess
import sys
import time

from script import HOODOO, TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
EDITS = f"{TOP}/tests/restart/edits.yaml"


def full_pipe():
    """A pipe into which nothing more fits: a program that prints to it waits."""
    reader, writer = os.pipe()
    fcntl.fcntl(writer, fcntl.F_SETPIPE_SZ, 4096)
    os.set_blocking(writer, False)
    try:
        while True:
            os.write(writer, b"\0" * 4096)
    except BlockingIOError:
        os.set_blocking(writer, True)
        return reader, writer


def waits(process):
    """Until the program sleeps and has used no CPU time for a moment."""
    def now():
        with open(f"/proc/{process.pid}/stat") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return fields[0], fields[11], fields[12]
    before = None
    for _ in range(600):
        time.sleep(0.1)
        after = now()
        if after[0] == "S" and after == before:
            return
        before = after


code, said = hoodoo("run", EDITS, "--out", "out", "--frames", "1001-1003", "--progress", "none")
ok(code == 0, "a run", said)
for number, words in [("TERM", ("check", EDITS)), ("INT", ("keys", "wind")), ("TERM", ("plan", EDITS, "--device", "none")), ("TERM", ("status", "out")), ("HUP", ("verify", "out")),
                      ("USR1", ("inspect", "out/run.json")), ("TERM", ("devices",)), ("XCPU", ("submit", EDITS, "--to", "slurm", "--dry-run"))]:
    reader, writer = full_pipe()
    process = subprocess.Popen([HOODOO, *words], stdout=writer, stderr=subprocess.PIPE, text=True)
    waits(process)
    process.send_signal(signal.Signals[f"SIG{number}"])
    said = process.communicate(timeout=60)[1]
    ok(process.returncode == 85 and said.splitlines()[-1:] == [f"hoodoo: stopped by SIG{number}; to start over, run the same command again"], f"{words[0]}: SIG{number} ends it with 85",
       process.returncode, said)
    os.close(reader)
    os.close(writer)

# The report waits for oiiotool, which here does not end.
os.mkdir("bin")
with open("bin/oiiotool", "w") as file:
    file.write("#!/bin/sh\n: >started\nexec sleep 300\n")
os.chmod("bin/oiiotool", 0o755)
for number in (signal.SIGTERM, signal.SIGINT):
    process = subprocess.Popen([HOODOO, "report", "out"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=dict(os.environ, PATH=f"{os.getcwd()}/bin:{os.environ['PATH']}"))
    for _ in range(600):
        if os.path.exists("out/started"):
            break
        time.sleep(0.1)
    started = os.path.exists("out/started")
    os.remove("out/started")
    process.send_signal(number)
    said = process.communicate(timeout=60)[0]
    left = os.listdir("out/report")
    ok(started and process.returncode == 85 and said.count("\n") == 1 and "run the same command again" in said and left == [], f"report: {number.name} ends it with 85, and no file is left",
       process.returncode, said, left)
code, said = hoodoo("report", "out")
ok(code == 0 and os.path.exists("out/report/index.html"), "report: run again, it ends", said)
finish()

"""Runs of twelve.yaml (12 frames) that are stopped where a test wants, and comparisons of their files."""

import fcntl
import hashlib
import os
import signal
import subprocess
import sys
import time

from script import fault, finish, ok

HOODOO = os.environ["HOODOO"]
JOB = os.path.join(os.environ["HOODOO_TOP"], "tests/restart/twelve.yaml")
FIRST, LAST = 1001, 1012
STOPPED, CHECKPOINT, OUTPUT = 85, 7, 4
PATIENCE = 120  # seconds for anything that takes one or two


def command(out, *options):
    return [HOODOO, "run", JOB, "--out", out, "--progress", "plain", *options]


def run(out, *options, env=None):
    """Runs the job to its end. Returns exit code and stderr."""
    done = subprocess.run(command(out, *options), stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
                          timeout=PATIENCE, env={**os.environ, **env} if env else None)
    return done.returncode, done.stderr


def manifest(out, frame):
    return os.path.join(out, "frames", f"twelve.{frame}.json")


def checkpoint(out, frame):
    return os.path.join(out, "checkpoint", f"twelve.{frame}.ckpt")


def checkpoints(out):
    """Frames, oldest first."""
    return sorted(int(name.split(".")[1]) for name in os.listdir(os.path.join(out, "checkpoint")) if name.endswith(".ckpt"))


class Held:
    """A run whose output goes into a pipe that holds one line, so that it cannot print a line before the one before has been read."""

    def __init__(self, out, *options):
        read, write = os.pipe2(os.O_DIRECT)  # packets: lines do not share the pipe's only page
        fcntl.fcntl(write, fcntl.F_SETPIPE_SZ, 4096)
        self.child = subprocess.Popen(command(out, *options), stderr=write, stdin=subprocess.DEVNULL)
        os.close(write)
        self.read, self.out, self.said = read, out, []

    def line(self):
        """The next line; "" at the end."""
        packet = os.read(self.read, 4096).decode()
        self.said.append(packet)
        return packet

    def line_of(self, start):
        """Reads up to a line with this start."""
        while not self.line().startswith(start):
            if self.said[-1] == "":
                raise RuntimeError(f"it ended before it said '{start}': {self.said}")

    def hold_at(self, frame):
        """Returns when `frame` has been written and the run is blocked on printing so, before it checks for signals."""
        before = {FIRST: "hoodoo: frames ", FIRST + 1: "hoodoo: about "}
        self.line_of(before.get(frame, f"hoodoo: frame {frame - 2},"))
        for _ in range(PATIENCE * 500):
            if os.path.exists(manifest(self.out, frame)):
                return
            time.sleep(0.002)
        raise RuntimeError(f"no frame {frame}")

    def kill(self, number):
        self.child.send_signal(number)

    def end(self):
        """Lets the run continue to its end. Returns exit code and output."""
        while self.line():
            pass
        os.close(self.read)
        return self.child.wait(PATIENCE), "".join(self.said)


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).digest()


def tree(out):
    """Every file except logs, with its digest."""
    found = {}
    for folder, _, names in os.walk(out):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), out)
            if not path.startswith("log/"):
                found[path] = digest(os.path.join(out, path))
    return found


class Truth:
    """The files of an uninterrupted run, and the checkpoint of every frame."""

    def __init__(self):
        for out, options in (("whole", ()), ("every", ("--set", "checkpoint.every=1", "--set", "checkpoint.keep=99"))):
            code, said = run(out, *options)
            if code:
                sys.exit(f"not ok an uninterrupted run: exit code {code}\n{said}")
        self.whole = tree("whole")
        self.checkpoint = {frame: digest(checkpoint("every", frame)) for frame in checkpoints("every")}

    def differences(self, out):
        """Differences to an uninterrupted run; "" if there are none. After a stop, the kept checkpoints may include one of another frame, which
        must equal the checkpoint of that frame in any run."""
        here = tree(out)
        bad = []
        kept = checkpoints(out)
        if len(kept) != 2 or kept[-1] != LAST:
            bad.append(f"checkpoints {kept}")
        for frame in kept:
            path = f"checkpoint/twelve.{frame}.ckpt"
            if here.pop(path) != self.checkpoint[frame]:
                bad.append(f"{path} differs")
        whole = {path: value for path, value in self.whole.items() if not path.startswith("checkpoint/")}
        for path in sorted(whole.keys() | here.keys()):
            if path not in here:
                bad.append(f"{path} is missing")
            elif path not in whole:
                bad.append(f"{path} is too much")
            elif whole[path] != here[path]:
                bad.append(f"{path} differs")
        return "; ".join(bad)


def stop(out, frame, number, times=1):
    """Stops a run by a signal after `frame` is written. Returns exit code and output."""
    held = Held(out)
    held.hold_at(frame)
    for _ in range(times):
        held.kill(number)
    return held.end()


def errors(said):
    """The lines after the last line of progress, information or warning."""
    return [line for line in said.splitlines() if not line.startswith(
        ("hoodoo: frame", "hoodoo: about ", "hoodoo: continuing ", "hoodoo: device time", "hoodoo: warning: ", "hoodoo: all "))]


SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU)

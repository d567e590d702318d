"""What scripts that run hoodoo have in common. run.sh puts this folder where Python looks."""

import hashlib
import os
import subprocess
import sys

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
failures = 0


def ok(good, name, *notes):
    """A line of TAP; the ends of the notes below it where it is bad."""
    global failures
    print("ok" if good else "not ok", name, flush=True)
    if not good:
        failures += 1
        for note in notes:
            for line in str(note).splitlines()[-60:]:
                print("#", line, flush=True)
    return good


def fault(kind, tried, what):
    """A row of the table in tests/README.md: what was done to hoodoo how often, and what came of it. Failures so far are what was lost."""
    print(f"# fault | {kind} | {tried} | {what} | {failures} |", flush=True)


def finish():
    sys.exit(1 if failures else 0)


def ask(*argv, **more):
    """Exit code, and what was said on stdout and stderr."""
    done = subprocess.run(argv, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, **{"timeout": 600, **more})
    return done.returncode, done.stdout


def hoodoo(*words, **more):
    return ask(HOODOO, *words, **more)


def cut_half(path):
    os.truncate(path, os.path.getsize(path) // 2)


def flip_bit(path, draw):
    """One bit that `draw` (random.Random) chooses, the size and the time as they were."""
    info = os.stat(path)
    with open(path, "r+b") as file:
        at = draw.randrange(info.st_size)
        file.seek(at)
        byte = file.read(1)[0]
        file.seek(at)
        file.write(bytes([byte ^ 1 << draw.randrange(8)]))
    os.utime(path, ns=(info.st_atime_ns, info.st_mtime_ns))


def tree(root, chosen):
    """{path below root: digest} of the files whose paths are chosen."""
    found = {}
    for folder, _, names in os.walk(root):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), root)
            if chosen(path):
                with open(os.path.join(root, path), "rb") as file:
                    found[path] = hashlib.sha256(file.read()).hexdigest()
    return found


def of_a_run(path):
    """What the simulation and the meshes leave. Pictures are made by programs that put dates into them, and checkpoints before
    the last frame's depend on where a run was stopped."""
    return path.startswith(("points", "volumes", "aov", "frames", "mesh", "job.yaml")) or path.endswith(".1012.ckpt")

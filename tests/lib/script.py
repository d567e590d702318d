"""Shared functions of test scripts. run.sh adds this folder to PYTHONPATH."""

import hashlib
import os
import subprocess
import sys

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
failures = 0
# A run of half a second, to which a test adds lines.
SMALL = """hoodoo: 1
name: small
model: goblins
frames: 1-3
clock: {years_per_frame: 300}
domain: {size_m: [4, 4, 5], spacing_m: 0.5}
scene: {cylinder: {from_m: [2, 2, 0], to_m: [2, 2, 4.5], radius_m: 1.5}}
strata: [{weak_m_per_kyr: 0.2}]
"""


def ok(good, name, *notes):
    """Prints a TAP line, and on failure the last lines of each note."""
    global failures
    print("ok" if good else "not ok", name, flush=True)
    if not good:
        failures += 1
        for note in notes:
            for line in str(note).splitlines()[-60:]:
                print("#", line, flush=True)
    return good


def fault(kind, tried, what):
    """Prints a row of the table in tests/README.md: the kind of fault, how often it was tried, and the outcome. Failures so far count as lost."""
    print(f"# fault | {kind} | {tried} | {what} | {failures} |", flush=True)


def finish():
    sys.exit(1 if failures else 0)


def ask(*argv, **more):
    """Returns the exit code and the output, stdout and stderr together."""
    done = subprocess.run(argv, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, **{"timeout": 600, **more})
    return done.returncode, done.stdout


def hoodoo(*words, **more):
    return ask(HOODOO, *words, **more)


def obstruct_meshes(root, name, frames):
    """Folders in the place of meshes, which then cannot be written, also by root."""
    for frame in frames:
        os.makedirs(f"{root}/mesh/{name}.{frame:04d}.obj")


def clear_meshes(root):
    for name in os.listdir(root + "/mesh"):
        if os.path.isdir(f"{root}/mesh/{name}"):
            os.rmdir(f"{root}/mesh/{name}")


def cut_half(path):
    os.truncate(path, os.path.getsize(path) // 2)


def flip_bit(path, draw):
    """Flips one bit, chosen by `draw` (random.Random); size and time stay the same."""
    info = os.stat(path)
    with open(path, "r+b") as file:
        at = draw.randrange(info.st_size)
        file.seek(at)
        byte = file.read(1)[0]
        file.seek(at)
        file.write(bytes([byte ^ 1 << draw.randrange(8)]))
    os.utime(path, ns=(info.st_atime_ns, info.st_mtime_ns))


def tree(root, chosen):
    """{path below root: digest} of the files for whose paths `chosen` is true."""
    found = {}
    for folder, _, names in os.walk(root):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), root)
            if chosen(path):
                with open(os.path.join(root, path), "rb") as file:
                    found[path] = hashlib.sha256(file.read()).hexdigest()
    return found


def of_a_run(path):
    """Is the file one of the simulation or of meshes? Pictures of other programs may contain dates, and checkpoints before the
    last frame depend on where a run was stopped."""
    return path.startswith(("points", "volumes", "aov", "frames", "mesh", "job.yaml")) or path.endswith(".1012.ckpt")

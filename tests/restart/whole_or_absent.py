"""Every kind of file, written to a disk that fills and by programs that are killed: a file under its final name is complete. With space and
without interruption, the same command then finishes."""
import os
import random
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from whole import files, wrong

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
SEED = int(os.environ.get("SEED", "1"))
PAGE = 4096
failed = False


def check(good, what, *notes):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)
    if not good:
        for note in notes:
            print("# " + str(note)[:600].replace("\n", "\n# "))


def start(words, where="."):
    return subprocess.Popen([HOODOO, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, cwd=where,
                            text=True, start_new_session=True)


def run(words, where="."):
    child = start(words, where)
    said = child.communicate(timeout=300)[1]
    return child.returncode, said


with open(TOP + "/tests/restart/twelve.yaml") as file:
    text = file.read().replace("1001-1012", "1001-1003").replace("every: 3", "every: 2")
with open("twelve.yaml", "w") as file:
    file.write(text)
with open(TOP + "/tests/restart/arches.sh") as file:
    text = file.read()
with open("terrain.yaml", "w") as file:
    file.write(text[text.index("hoodoo: 1"):text.index("\nJOB\n") + 1].replace("frames: 1-8", "frames: 1-3"))
HERE = os.getcwd()
# Each step needs the results of the steps before. {out}: the folder. The last item: where the step writes.
STEPS = [
    ("run", ["run", HERE + "/twelve.yaml", "--out", "{out}", "--progress", "none"], "points"),
    ("mesh", ["mesh", "{out}", "--frames", "1001-1003x2", "--progress", "none"], "mesh"),
    ("aov", ["aov", "{out}", "--camera", "main", "--frames", "1001-1003x2", "--set", "output.aov.samples=4", "--set",
             "output.aov.cryptomatte=true", "--progress", "none"], "aov"),
    ("preview", ["preview", "{out}", "--frames", "1001-1003x2", "--preset", "draft", "--resolution", "96x54", "--progress", "none"], "preview"),
    ("turntable", ["preview", "{out}", "--turntable", "--views", "3", "--preset", "draft", "--resolution", "96x54", "--progress", "none"], "turntable"),
    ("report", ["report", "{out}"], "report"),
    ("submit", ["submit", HERE + "/twelve.yaml", "--to", "openjd", "--out", "{out}"], "farm"),
    ("arches", ["run", HERE + "/terrain.yaml", "--out", "{out}_terrain", "--set", "arches.stacks=all", "--progress", "none"], "stacks"),
]


def words_of(step, out):
    return [w.replace("{out}", out) for w in step[1]]


def size_of(root):
    return sum((os.path.getsize(os.path.join(root, f)) + PAGE - 1) // PAGE * PAGE + PAGE for f in files(root))


def left_by(root):
    return [f for f in files(root) if ".tmp-" in f]


os.makedirs("disk", exist_ok=True)
can_mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64m", "tmpfs", "disk"], stderr=subprocess.DEVNULL).returncode == 0
if can_mount:
    subprocess.run(["umount", "disk"])
else:
    print("ok a full disk # skipped: no tmpfs can be mounted here")


def fill_up(step, before, grown):
    """Runs the step on disks with space for various shares of what it adds."""
    bad, codes, after = [], [], ""
    for share in (0.03, 0.25, 0.55, 0.9):
        size = size_of(before) if os.path.isdir(before) else 0
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={int(size + share * grown + 8 * PAGE)}", "tmpfs", "disk"], check=True)
        try:
            if size:
                shutil.copytree(before, "disk/out")
            code, said = run(words_of(step, "disk/out"))
            codes.append(code)
            bad += [f"{share}: {path}" for path in wrong("disk")]
            bad += [f"{share}: left {path}" for path in left_by("disk")]
            if code not in (0, 4):
                bad.append(f"{share}: exit code {code}: {said.strip()}")
            subprocess.run(["mount", "-o", "remount,size=256m", "disk"], check=True)
            code, after = run(words_of(step, "disk/out"))
            bad += [f"{share}, then room: {path}" for path in wrong("disk")]
            if code:
                bad.append(f"{share}, then room: exit code {code}: {after.strip()}")
        finally:
            subprocess.run(["umount", "disk"], check=True)
    check(not bad, f"{step[0]}: on a full disk what is there is whole, and with room it finishes (exit codes {codes})", *bad)
    # a report without pictures is still a report; a template fits into the rest of a page
    if step[0] not in ("report", "submit"):
        check(4 in codes, f"{step[0]}: a full disk is exit code 4")


def kill_at(step, before, length, moments):
    """Kills the step and its children at several moments, then runs it again."""
    bad, killed, halves = [], 0, 0
    for i in range(3):
        for folder in ("killed", "killed_terrain"):
            while os.path.isdir(folder):  # a killed process may still be ending
                shutil.rmtree(folder, ignore_errors=True)
        if os.path.isdir(before):
            shutil.copytree(before, "killed")
        child = start(words_of(step, "killed"))
        time.sleep(length * moments.uniform(0.1, 1))
        try:
            os.killpg(child.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        child.communicate()
        killed += child.returncode == -signal.SIGKILL
        for folder in ("killed", "killed_terrain"):
            if os.path.isdir(folder):
                halves += len(left_by(folder))
                bad += [f"killed: {path}" for path in wrong(folder)]
    # Kills rarely leave temporary files, so an old one of another machine is added; it must be removed, too.
    root = "killed_terrain" if step[0] == "arches" else "killed"
    for folder in (root, f"{root}/{step[2]}", f"{root}/records/{step[2]}"):
        os.makedirs(folder, exist_ok=True)
        forgotten = folder + "/forgotten.tmp-00000000-1-0-0"
        with open(forgotten, "w"):
            os.utime(forgotten, (0, 0))
    code, said = run(words_of(step, "killed"))
    if code:
        bad.append(f"again: exit code {code}: {said.strip()}")
    for folder in ("killed", "killed_terrain"):
        if os.path.isdir(folder):
            bad += [f"again: {path}" for path in wrong(folder)] + [f"again: left {path}" for path in left_by(folder)]
    check(not bad, f"{step[0]}: killed {killed} times (seed {SEED}), {halves} temporary files left, what has its name is whole", *bad)


moments = random.Random(SEED)
seen = {}
for number, step in enumerate(STEPS):
    before = f"whole_{number}"
    if os.path.isdir("out"):
        shutil.copytree("out", before)
    had = sum(size_of(folder) for folder in ("out", "out_terrain") if os.path.isdir(folder))
    begun = time.monotonic()
    code, said = run(words_of(step, "out"))
    length = time.monotonic() - begun
    check(code == 0, f"{step[0]}: by itself", said)
    grown = sum(size_of(folder) for folder in ("out", "out_terrain") if os.path.isdir(folder)) - had
    if can_mount:
        fill_up(step, before, grown)
    kill_at(step, before, length, moments)
    shutil.rmtree(before, ignore_errors=True)
for folder in ("out", "out_terrain"):
    bad = wrong(folder, seen)
    check(not bad, f"{folder}: every file is whole", *bad)
print("# read: " + ", ".join(f"{n} {kind}" for kind, n in sorted(seen.items())))
WANTED = {"vdb", "exr", "png", "jpg", "ply", "obj", "usdc", "usda", "mp4", "html", "json", "yaml", "ckpt", "stacks"}
check(WANTED <= seen.keys(), "all kinds of files were among them", WANTED - seen.keys())

# The readers must detect truncated files of each kind.
for kind in sorted(WANTED):
    path = next(os.path.join(folder, f) for folder in ("out", "out_terrain") if os.path.isdir(folder) for f in files(folder)
                if f.endswith("." + kind) and ".tmp-" not in f)
    size = os.path.getsize(path)
    kept = open(path, "rb").read()
    blind = []
    for keep in (0.3, 0.8, 0.995):
        os.truncate(path, int(size * keep))
        if not wrong(os.path.dirname(path) or "."):
            blind.append(keep)
    with open(path, "wb") as file:
        file.write(kept)
    check(not blind, f"a cut {kind} is noticed", blind)
sys.exit(failed)

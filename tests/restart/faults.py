"""One call fails, of all that a small run and the verbs after it make about files and about the device's memory: an error with a code of
the table and a sentence, no partial file, and the same command then finishes with the same bytes. By default a few calls of each kind fail;
with FAULTS=all, each."""

import glob
import os
import random
import shutil
import subprocess
import sys

sys.dont_write_bytecode = True
from script import *

HERE = os.getcwd()
OUT = HERE + "/out"
EACH = os.environ.get("FAULTS") == "all"
ONLY = os.environ.get("ONLY", "").split()
JOB = SMALL + """checkpoint: {every: 1, keep: 2}
cameras: {main: {orbit: {target_m: [2, 2, 2], distance_m: 12}, resolution: [32, 18]}}
output: {aov: {cameras: [main]}}
"""
with open("small.yaml", "w") as file:
    file.write(JOB)
SHIM = HERE + "/fault.so"
subprocess.run(["gcc", "-std=c11", "-D_GNU_SOURCE", "-O1", "-shared", "-fPIC", "-o", SHIM, TOP + "/tests/restart/lib/fault_shim.c", "-ldl"], check=True)
EIO, EMFILE, ENOSPC, ESTALE, ENOMEM = 5, 24, 28, 116, 12
ERRORS = {"open": (EIO, EMFILE, ESTALE), "fopen": (EIO, EMFILE), "write": (EIO, ENOSPC), "pwrite": (EIO, ENOSPC), "writev": (EIO, ENOSPC),
          "mkdir": (EIO, ENOSPC), "rename": (EIO, ENOSPC, ESTALE), "link": (EIO, ESTALE), "mmap": (EIO, ENOMEM), "opendir": (EIO, EMFILE)}
draw = random.Random(int(os.environ.get("SEED", "1")))
tried = {"files": 0, "device": 0}


def everything(path):
    return not path.startswith(("log/", "lock"))


def ask_with(words, **fault):
    if os.path.exists("notes"):
        os.remove("notes")
    try:
        return ask(HOODOO, *words, timeout=120, env={**os.environ, "HOODOO_CACHE": HERE + "/cache", "LD_PRELOAD": SHIM, "FAULT_NOTES": HERE + "/notes",
                                                      "FAULT_UNDER": HERE, **fault})
    except subprocess.TimeoutExpired:
        return "hangs", ""


def notes():
    with open("notes") as file:
        pairs = [line.split(" ", 1) for line in file.read().splitlines()]
    about = dict(pairs).pop("about", "").strip()
    return {name: int(count) for name, count in pairs if name != "about"}, about.replace(HERE + "/", "")


def partial(whole):
    """Files that are neither those of the whole run nor a stage of the frames so far."""
    bad = []
    for path, digest in tree("out", everything).items():
        if ".tmp-" in path or whole.get(path) == digest:
            continue
        if path.endswith((".usda", ".usda.json", "job.yaml.json", "run.json.json", "run.json")) and path in whole:
            with open("out/" + path) as file:
                if file.read().endswith("}\n"):
                    continue
        if path.startswith("checkpoint/") and hoodoo("inspect", "out/" + path)[0] == 0:
            continue
        bad.append(path)
    return bad


def one(words, before, whole, call, at, error):
    shutil.rmtree("out", ignore_errors=True)
    if before:
        shutil.copytree(before, "out")
    code, said = ask_with(words, FAULT_CALL=call, FAULT_AT=str(at), FAULT_ERROR=str(error))
    about = notes()[1] if os.path.exists("notes") else "?"
    if not about:
        return None  # fewer calls this time
    bad = []
    lines = [line for line in said.splitlines() if line.startswith("hoodoo: ")]
    wanted = (6,) if call in ("vkQueueSubmit", "vkWaitForFences") else (5,) if call.startswith("vk") else (0, 3, 4, 5, 7)
    if code not in wanted or (code != 0 and not lines):
        bad.append(f"exit {code}: {said[-300:]}")
    half = partial(whole)
    if half:
        bad.append(f"partial: {half}")
    if "cannot remove this old checkpoint" in said:
        os.remove("out/" + about[len("out/"):])
    if code == 0 and tree("out", everything) != whole:
        bad.append(f"exit 0, but {[p for p in {*whole, *tree('out', everything)} if tree('out', everything).get(p) != whole.get(p)]}: {said[-300:]}")
    again, more = ask(HOODOO, *words, timeout=120)
    now = tree("out", everything)
    if again != 0 or now != whole:
        bad.append(f"again: exit {again}, {[p for p in {*whole, *now} if now.get(p) != whole.get(p)]}: {more[-300:]}")
    return [f"{call} {at}, error {error}, {about}: {line}" for line in bad]


def campaign(name, words, before=None, few=1):
    shutil.rmtree("out", ignore_errors=True)
    if before:
        shutil.copytree(before, "out")
    code, said = ask_with(words)
    counts, _ = notes()
    whole = tree("out", everything)
    ok(code == 0 and counts["read"] + counts["open"] > 3, f"{name}: undisturbed", code, said, counts)
    if not before:
        shutil.copytree("out", "done")
        for path in glob.glob("done/*/small.0003.*"):
            os.remove(path)
    for kind in ("files", "device"):
        bad, n = [], 0
        for call in sorted(counts):
            if call.startswith("vk") != (kind == "device") or not counts[call] or (ONLY and call not in ONLY):
                continue
            every = range(1, counts[call] + 1)
            for at in every if EACH else sorted(draw.sample(every, min(few, counts[call]))):
                found = one(words, before, whole, call, at, draw.choice(ERRORS.get(call, (EIO,))))
                n += 1
                bad += found or []
        tried[kind] += n
        if n:
            ok(not bad, f"{name}: {n} calls about {'files' if kind == 'files' else 'the device'} fail, one at a time", "\n".join(bad))


campaign("run", ["run", HERE + "/small.yaml", "--device", "cpu", "--out", OUT, "--progress", "none"])
campaign("resume", ["run", HERE + "/small.yaml", "--device", "cpu", "--out", OUT, "--progress", "none"], "done")
campaign("mesh", ["mesh", OUT, "--progress", "none"], "done")
fault("calls about files that fail once with EIO, ENOSPC, EMFILE, ESTALE or ENOMEM", tried["files"],
      "an exit code of the table and a sentence, or nothing lost; no partial file; the same command ends with the same bytes")
fault("device memory, pipelines and pools that cannot be had, submissions and waits that lose the device", tried["device"],
      "exit code 5 or 6 with a sentence, then the same bytes")
finish()

"""Failed allocations in every command: exit code 5, one message, no partial file, and the same command then finishes with the same
bytes. By default a sample of the allocations of each command fails; with NO_MEMORY=all, one for each distinct call stack."""
import hashlib
import os
import random
import shutil
import subprocess

TOP, HOODOO, HERE = os.environ["HOODOO_TOP"], os.environ["HOODOO"], os.getcwd()
ALL = os.environ.get("NO_MEMORY") == "all"
ONLY = os.environ.get("ONLY", "").split()
SHIM, NOTES = HERE + "/no_memory.so", HERE + "/notes"
DEADLINE_S = 600
NOISE = ("hoodoo: warning: arches.operations", "hoodoo: about ", "hoodoo: device time", "hoodoo: continuing ", "hoodoo: frames ")
# Products that a run may fail to write and still succeed, which it then logs.
BY_DESIGN = ("log/timing.jsonl: out of memory", "log/frames.jsonl: out of memory", "out: old checkpoints stay: out of memory")
random.seed(int(os.environ.get("SEED", "1")))


def between(path, first, last):
    with open(os.path.join(TOP, path)) as file:
        text = file.read()
    return text[text.index(first):text.index(last) + 1]


def job(name, text, frames):
    """A job of these frames that keeps a checkpoint of each."""
    lines = [line for line in text.split("\n") if not line.startswith(("frames:", "checkpoint:"))]
    with open(name + ".yaml", "w") as file:
        file.write("\n".join(lines) + f"\nframes: {frames}\ncheckpoint: {{every: 1, keep: 9}}\n")


with open(TOP + "/tests/restart/twelve.yaml") as file:
    job("arenite", file.read(), "1001-1002")
with open(TOP + "/tests/gpu/falling.yaml") as file:
    job("collapse", file.read().replace("0.125", "0.02"), "1001-1002")
job("goblins", between("tests/restart/goblins.sh", "hoodoo: 1", "\nJOB\n"), "1-2")
job("arches", between("tests/restart/arches.sh", "hoodoo: 1", "\nJOB\n"), "1-3")
subprocess.run(["g++", "-std=c++17", "-O1", "-shared", "-fPIC", "-o", SHIM, TOP + "/tests/restart/lib/no_memory_shim.cpp"], check=True)


def run(words, nth=None):
    """Exit code (negative: a signal), output without ordinary lines, and the notes of the shim."""
    if os.path.exists(NOTES):
        os.remove(NOTES)
    env = dict(os.environ)
    env.pop("NO_MEMORY", None)
    if nth is not None:
        env.update(LD_PRELOAD=SHIM, NO_MEMORY=f"{nth} {NOTES}")
    try:
        done = subprocess.run([HOODOO, *words], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              errors="replace", env=env, timeout=DEADLINE_S)
    except subprocess.TimeoutExpired:
        return "hangs", [], ["0"]
    noted = []
    if os.path.exists(NOTES):
        with open(NOTES) as file:
            noted = file.read().split()
    return done.returncode, [line for line in done.stderr.splitlines() if not line.startswith(NOISE)], noted


def tree(out):
    """Every file except logs, with its digest."""
    found = {}
    for folder, _, names in os.walk(out):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), out)
            if not path.startswith("log/"):
                with open(os.path.join(out, path), "rb") as file:
                    found[path] = hashlib.sha256(file.read()).hexdigest()
    return found


def half(whole):
    """Files that are neither equal to a file of the whole run, nor a stage of the frames so far, nor its record."""
    bad = []
    for path, digest in tree("out").items():
        if path.endswith((".usda", ".usda.json")) and path in whole:
            with open(os.path.join("out", path)) as file:
                if not file.read().endswith("}\n"):
                    bad.append(path)
        elif whole.get(path) != digest:
            bad.append(path)
    return bad


def lost_by_design():
    """Did the run log that it failed to write a product that it may lose, with no other difference?"""
    if not os.path.exists("out/log/run.log"):
        return False
    with open("out/log/run.log", errors="replace") as file:
        log = file.read()
    return any(words in log for words in BY_DESIGN)


def fail_one(words, nth, whole):
    """The problem after the nth allocation of the command fails; None if it made fewer allocations this time (the count depends on threads)."""
    bad = []
    code, said, noted = run(words, nth)
    if not noted:
        return None
    if not (code == 0 and lost_by_design()) and (code != 5 or len(said) != 1 or "memory" not in said[0]):
        bad.append(f"exit code {code}: {said}")
    bad += [f"half: {path}" for path in half(whole)]
    code, said, _ = run(words)
    if code != 0:
        bad.append(f"then with memory: exit code {code}: {said}")
    now = tree("out") if whole else whole
    if now != whole:
        bad.append(f"then with memory: {[p for p in sorted({*now, *whole}) if now.get(p) != whole.get(p)]} differ")
    return [f"allocation {nth}: {line}" for line in bad]


def command(name, words, before=None, few=2):
    """Runs the command with each chosen allocation failing, on a copy of the folder `before`; then once more without failures."""
    def prepare():
        shutil.rmtree("out", ignore_errors=True)
        if before:
            shutil.copytree(before, "out")

    prepare()
    code, said, noted = run(words, 0)
    whole = tree("out")
    if before is None and whole:
        os.rename("out", name + "_whole")
    bad = [] if code == 0 and noted else [f"left alone: exit code {code}: {said}"]
    first = {}
    for at, who in enumerate(noted, 1):
        first.setdefault(who, at)
    chosen = sorted(first.values())
    if not ALL:
        chosen = sorted(random.sample(chosen, min(few, len(chosen))))
    if ONLY and name not in ONLY:
        chosen = []
    tried = 0
    for nth in chosen:
        prepare()
        found = fail_one(words, nth, whole)
        tried += found is not None
        bad += found or []
    print(("not ok " if bad else "ok ") + f"{name}: {tried} of its {len(noted)} allocations ({len(first)} askers) fail, one at a time")
    for line in bad:
        print("# " + line[:800], flush=True)
    return name + "_whole"


for model in ("arenite", "collapse", "goblins", "arches"):
    done = command(model, ["run", f"{HERE}/{model}.yaml", "--out", "out", "--progress", "none"])
    if model in ("arenite", "arches"):
        command(model + "_mesh", ["mesh", "out", "--progress", "none"], done, 1)
    if model == "arenite":
        command("plan", ["plan", "--rehearse", "0", HERE + "/arenite.yaml"])
        for verb in ("status", "verify", "report"):
            command(verb, [verb, "out"], done)

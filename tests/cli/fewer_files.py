"""Frames without files are not sampled: when a job writes every third frame, all models sample and render only those. Written files, and the
statistics in all manifests, equal those of a job that writes every frame."""
import hashlib
import json
import os
import subprocess
import sys

TOP, HOODOO = os.environ["HOODOO_TOP"], os.environ["HOODOO"]
FRAMES = range(1, 8)  # 1, 4 and 7 have files
FEWER = ["output.vdb.every=3", "output.aov.every=3"]
SHOWING = {"field", "pictures"}  # stages that only files need
failures = 0


def ok(good, name, *notes):
    global failures
    print("ok" if good else "not ok", name, *notes, flush=True)
    failures += not good


def job(name, text):
    """The job with these frames and a picture."""
    lines = [line for line in text.split("\n") if not line.startswith("frames:")]
    with open(name + ".yaml", "w") as file:
        file.write("\n".join(lines) + f"\nframes: {FRAMES[0]}-{FRAMES[-1]}\n")
        if not any(line.startswith("cameras:") for line in lines):
            file.write("cameras: {main: {orbit: {target_m: [3, 3, 3], distance_m: 15}, resolution: [32, 18]}}\noutput: {aov: {cameras: [main]}}\n")


def embedded(path, first, last):
    with open(os.path.join(TOP, path)) as file:
        text = file.read()
    return text[text.index(first):text.index(last) + 1]


def run(name, out, sets):
    words = [HOODOO, "run", name + ".yaml", "--out", out, "--progress", "none"]
    said = subprocess.run(words + [word for s in sets for word in ("--set", s)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if said.returncode:
        raise SystemExit(f"not ok {name}: {said.stdout}")
    with open(out + "/log/timing.jsonl") as file:
        return {s["name"]: s["dispatches"] for s in json.loads(file.readline())["stages"]}


def manifest(out, name, frame):
    with open(f"{out}/frames/{name}.{frame:04d}.json") as file:
        return json.load(file)


def measures(m):
    """The manifest without files and stress iterations (in Goblins, stress is computed for display only)."""
    told = {key: value for key, value in m.items() if key not in ("files", "output_xxh3", "self_xxh3")}
    told["statistics"] = {key: value for key, value in m["statistics"].items() if key != "stress_iterations"}
    return told


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


with open(TOP + "/tests/restart/twelve.yaml") as file:
    job("arenite", file.read())
job("goblins", embedded("tests/restart/goblins.sh", "hoodoo: 1", "\nJOB\n"))
job("arches", embedded("tests/restart/arches.sh", "hoodoo: 1", "\nJOB\n"))
for model in ("arenite", "goblins", "arches"):
    all_of_it, fewer = model + "_all", model + "_fewer"
    whole, less = run(model, all_of_it, []), run(model, fewer, FEWER)
    with open(model + "_all/job.yaml") as file:
        name = next(line.split()[1].strip("\"") for line in file if line.startswith("name:"))
    drawn = {stage for stage in SHOWING if whole.get(stage)}
    ok(drawn and all(less.get(stage, 0) * 7 == whole[stage] * 3 for stage in drawn), f"{model}: three of seven frames are drawn",
       {stage: (less.get(stage), whole[stage]) for stage in drawn})
    bad, files = [], 0
    for frame in FRAMES:
        a, b = manifest(all_of_it, name, frame), manifest(fewer, name, frame)
        if measures(a) != measures(b):
            bad.append(f"frame {frame}: {measures(a)} and {measures(b)}")
        listed = {f["path"]: f for f in b["files"]}
        files += len(listed)
        if bool(listed) != ((frame - FRAMES[0]) % 3 == 0):
            bad.append(f"frame {frame} has {sorted(listed)}")
        bad += [path for path in listed if digest(f"{all_of_it}/{path}") != digest(f"{fewer}/{path}")]
    ok(files and not bad, f"{model}: its {files} files and all measures are as if every frame was written", bad[:3])
sys.exit(failures > 0)

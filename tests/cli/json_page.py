"""src/cli/JSON.md lists the members of every answer and file in JSON: none is missing there, and all that are always there exist."""

import json
import os
import re
import sys

from script import TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = {
    "hoodoo": 1, "name": "a", "frames": "1-3", "domain": {"size_m": [8, 8, 8], "spacing_m": 1}, "scene": {"box": {"min_m": [2, 2, 0], "max_m": [6, 6, 6]}},
    "strata": [{"interlock_MPa": 30}], "cameras": {"main": {"orbit": {"target_m": [4, 4, 3], "distance_m": 20}, "resolution": [48, 32]}},
    "output": {"aov": {"cameras": ["main"]}},
}
page, section = {}, None
with open(f"{TOP}/src/cli/JSON.md") as file:
    for line in file:
        if line.startswith("## "):
            section = page.setdefault(line[3:].strip(), {})
        elif line.startswith("| `"):
            names, what = line.split("|")[1:3]
            for name in re.findall("`([^`]+)`", names):
                section[name] = what.strip().startswith("if ")


def members(value, path=""):
    """Paths of all leaves and of lists."""
    if isinstance(value, dict):
        return {p for key, inner in value.items() for p in members(inner, f"{path}.{key}" if path else key)}
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return {p for item in value for p in members(item, f"{path}[]")}
    return {path}


def compare(name, value, *needed):
    """`needed`: members that are there sometimes, and are in this answer."""
    listed, found = page[name], members(value)
    known = re.compile("|".join(re.escape(n).replace(r"\*", ".*") + "$" for n in listed))
    strange = {m for m in found if not known.match(m)}
    prefixes = found | {m[:i] for m in found for i in range(len(m)) if m[i] in ".["}
    absent = {n for n, sometimes in listed.items() if not sometimes and n.split(".*")[0] not in prefixes}
    ok(value.get("format") == 1 and not strange and not absent and set(needed) <= found, f"{name}", value.get("format"), "not listed:", strange, "not there:", absent,
       set(needed) - found)


def answer(*words, exit=0):
    code, said = hoodoo(*words)
    ok(code == exit, " ".join(words), code, said)
    return json.loads(said[said.index("{\n"):said.rindex("}") + 1])


def load(path):
    with open(path) as file:
        return json.loads(file.readline() if path.endswith("l") else file.read())


with open("job.json", "w") as file:
    json.dump(JOB, file)
wedges = {**JOB, "wedge": {"over": [{"key": "seed", "values": [1, 2]}]}}
with open("wedges.json", "w") as file:
    json.dump(wedges, file)
with open("cube.obj", "w") as file:
    file.write("".join(f"v {x} {y} {z}\n" for x in (2, 6) for y in (2, 6) for z in (0, 6)))
    file.write("f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
hoodoo("run", "job.json", "--out", "out", "--progress", "none")
compare("hoodoo plan JOB --json", answer("plan", "job.json", "--json", "--set", "scene={mesh: {file: cube.obj}}", "--nodes", "1,2", "--price", "2/h"), "device",
        "inputs[].own_m3", "groups[].says", "estimated_from", "nodes[].cost", "critical_path")
compare("hoodoo plan JOB --json", answer("plan", "wedges.json", "--json", "--device", "none"), "wedges[].values")
compare("hoodoo submit JOB --to tasks --json", answer("submit", "job.json", "--to", "tasks", "--json", "--out", "farm"))
compare("hoodoo check JOB --json", answer("check", "wedges.json", "--json"), "warnings[].wedge", "warnings[].place")
compare("hoodoo check JOB --json", answer("check", "job.json", "--json", "--set", "strata.0.interlock_MPa=0.1"))
code, said = hoodoo("look", "job.json", "--json", "--progress", "none")
compare("hoodoo look JOB --json", json.loads(said.splitlines()[-1]))
compare("hoodoo status OUT --json", answer("status", "out", "--json"), "checkpoints")
compare("hoodoo status OUT --json", answer("status", "farm", "--json"), "tasks[].state")
compare("hoodoo verify OUT --json", answer("verify", "out", "--json"))
compare("hoodoo devices --json", answer("devices", "--json"))
compare("hoodoo inspect FILE.ckpt --json", answer("inspect", "out/checkpoint/a.0003.ckpt", "--json"))
compare("hoodoo inspect FILE.vdb --json", answer("inspect", "out/volumes/a.0003.vdb", "--json"))
compare("hoodoo inspect FILE.vdb --json", answer("inspect", "out/points/a.0003.vdb", "--json"), "grids[].points")
compare("hoodoo inspect FILE.exr --json", answer("inspect", "out/aov/a.0003.exr", "--json"))
for name in ("out/frames/a.0003.json", "out/run.json", "out/records/job.yaml.json"):
    compare("hoodoo inspect FILE.json --json", answer("inspect", name, "--json"))
compare("OUT/run.json", load("out/run.json"))
hoodoo("run", "job.json", "--out", "out", "--progress", "none", "--continue", "--set", "edits=[{frame: 3, carve: {box: {min_m: [5, 2, 5], max_m: [6, 6, 6]}}}]")
compare("OUT/run.json", load("out/run.json"), "changed[].frame")
hoodoo("run", "job.json", "--out", "branch", "--progress", "none", "--from", "out@3", "--set", "scene={mesh: {file: cube.obj}}")
compare("OUT/run.json", load("branch/run.json"), "from.frame", "inputs[].xxh3")
compare("OUT/log/timing.jsonl", load("out/log/timing.jsonl"))
os.remove("out/points/a.0003.vdb")
compare("hoodoo verify OUT --json", answer("verify", "out", "--json", exit=3), "problems[].kind")
compare("hoodoo status OUT --json", answer("status", "out", "--json", exit=0), "damage[].what")
finish()

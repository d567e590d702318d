"""hoodoo check: problems that a supervisor would notice are reported before a run, with their place in the file; sound jobs have no warnings."""
import copy
import glob
import json
import os
import sys
import time

from script import TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
GOOD = {
    "hoodoo": 1, "name": "block", "frames": "1001-1050", "clock": {"years_per_frame": 500}, "domain": {"size_m": [40, 30, 30], "spacing_m": 0.5},
    "scene": {"box": {"min_m": [8, 8, 0], "max_m": [32, 22, 24]}}, "strata": [{"to_m": 10, "interlock_MPa": 0.5}, {"interlock_MPa": 0.5}],
    "cameras": {"main": {"orbit": {"target_m": [20, 15, 12], "distance_m": 70}}},
}


def edited(path, value):
    job = copy.deepcopy(GOOD)
    at = job
    *parents, last = path.split("/")
    for part in parents:
        at = at[int(part)] if isinstance(at, list) else at.setdefault(part, {})
    if isinstance(at, list):
        at[int(last)] = value
    else:
        at[last] = value
    return job


def check(job, *options):
    with open("job.json", "w") as file:
        json.dump(job, file, indent=1)
    code, said = hoodoo("check", "job.json", "--json", *options)
    return code, json.loads(said)["warnings"] if said.lstrip().startswith("{") else said


# The edited key, its value, the key in the warning, and a part of its text.
SURPRISES = [
    ("domain/size_m", [20, 30, 30], "domain.size_m", "cut off"),
    ("scene", {"box": {"min_m": [-20, 8, 0], "max_m": [32, 22, 24]}}, "domain.size_m", "cut off"),
    ("scene", {"union": [GOOD["scene"], {"box": {"min_m": [10, 10, 24], "max_m": [30, 20, 24.2], "inert": True}}]}, "scene", "0.2 m thick"),
    ("strata", [{"to_m": 10}, {"to_m": 10.1}, {"to_m": 24}], "strata.1.to_m", "0.1 m thick"),
    ("noise", {"amplitude": 0.2, "scale_m": 0.6}, "noise.scale_m", "finer"),
    ("strata", [{"interlock_MPa": 200000}], "strata.0.interlock_MPa", "no grains ever interlock"),
    ("strata", [{"interlock_MPa": 30}], "strata.0.interlock_MPa", "no grains ever interlock"),
    ("strata", [{"interlock_MPa": 1e-5}], "strata.0.interlock_MPa", "from the start"),
    ("strata", [{"weak_m_per_kyr": 50, "interlock_MPa": 0.5}], "strata.0.weak_m_per_kyr", "little will be left"),
    ("strata", [{"weak_m_per_kyr": 0.0001, "interlock_MPa": 0.5}], "strata.0.weak_m_per_kyr", "hardly anything"),
    ("clock/years_per_frame", 1, "strata.0.weak_m_per_kyr", "hardly anything"),
    ("cameras/main", {"position_m": [20, 15, 12], "target_m": [20, 15, 50]}, "cameras.main", "inside the rock"),
    ("cameras/main", {"position_m": [-40, 15, 12], "target_m": [-80, 15, 12]}, "cameras.main", "does not see"),
    ("cameras/main", {"position_m": [-40, 15, -3], "target_m": [20, 15, 12]}, "cameras.main", "below the ground"),
    ("cameras/main", {"position_m": {1001: [-40, 15, 12], 1050: [20, 15, 400]}, "target_m": {1001: [20, 15, 12], 1050: [20, 15.1, 900]}}, "cameras.main", "does not see"),
    ("edits", [{"frame": 1100, "set": {"wind.speed_m_s": 3}}], "edits.0.frame", "never made"),
    ("wind", {"gusts": [{"frames": "2001-2010", "factor": 2}]}, "wind.gusts.0.frames", "none of the job's frames"),
    ("sources", [{"path_m": [[100, 100, 5]], "m3_per_yr": 10}], "sources.0.path_m", "in the domain"),
    ("goblins", {"threshold": 0.1}, "goblins", "model: arenite has no goblins"),
    ("strata_from", [{"thickness_m": 0.2}], "strata_from.0.thickness_m", "act together"),
    ("strata_from", [{"cross": {"set_m": 4, "lamina_m": 0.1}}], "strata_from.0.cross.lamina_m", "hardly anything of them shows"),
    ("joints", [{"spacing_m": 0.8}], "joints.0.spacing_m", "too thin to show"),
]
for path, value, key, words in SURPRISES:
    code, found = check(edited(path, value))
    named = [w for w in found if isinstance(w, dict) and w["key"] == key and words in w["warning"]]
    ok(code == 0 and named, f"{path}: {json.dumps(value)[:60]} -> {key}: {words}", code, found)
other = {**edited("wind", {"speed_m_s": 14}), "model": "goblins", "rain": {"m_per_yr": 1}}
code, found = check(other)
ok(code == 0 and {"wind", "rain"} <= {w["key"] for w in found}, "goblins have no wind and no rain", found)


def obj(name, *boxes):
    """Writes boxes as closed meshes, each given by lo, hi and whether it is inside out."""
    with open(name, "w") as file:
        for i, (lo, hi, inner) in enumerate(boxes):
            for corner in range(8):
                file.write("v %g %g %g\n" % tuple((hi if corner >> a & 1 else lo)[a] for a in range(3)))
            for face in ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)):
                file.write("f %s\n" % " ".join(str(8 * i + v) for v in (reversed(face) if inner else face)))


# The volume of a mesh or grid by its own measure, and as sampled.
OUTER, INNER = ((8, 8, 0), (32, 22, 24)), ((12, 12, 4), (28, 18, 20))
obj("solid.obj", (*OUTER, False))
obj("hollow.obj", (*OUTER, False), (*INNER, True))
obj("double.obj", (*OUTER, False), (*INNER, False))
obj("plate.obj", ((8.05, 8, -1), (8.35, 22, 24), False))
VOLUME = 24 * 14 * 24
for name, own in (("solid", VOLUME), ("hollow", VOLUME - 16 * 6 * 16)):
    with open("job.json", "w") as file:
        json.dump({**GOOD, "scene": {"mesh": {"file": name + ".obj"}}}, file)
    code, said = hoodoo("check", "job.json")
    numbers = [float(word) for line in said.splitlines() if " by its own measure, and " in line for word in line.split(".obj: ")[1].split(";")[0].replace(" m3", "").split() if word[0].isdigit()]
    ok(code == 0 and len(numbers) == 3 and abs(numbers[0] / own - 1) < 0.001 and abs(numbers[1] / own - 1) < 0.02, f"{name}.obj holds {own} m3, and so it is sampled", said)
for name, words in (("double", "less"), ("plate", "%")):
    code, said = hoodoo("check", "job.json", "--set", f"scene={{mesh: {{file: {os.path.abspath(name)}.obj}}}}", "--set", "cameras={}")
    ok(code == 0 and "by its own measure" in said and "scene" in said and words in said, f"{name}.obj is another rock than it says", said)
    code, said = hoodoo("plan", "job.json", "--rehearse", "0", "--json", "--set", f"scene={{mesh: {{file: {os.path.abspath(name)}.obj}}}}", "--set", "cameras={}")
    ok(code == 0 and "by its own measure, but" in said and '"own_m3"' in said, f"plan says so of {name}.obj, too", said)
code, said = hoodoo("plan", "job.json", "--rehearse", "0", "--json", "--set", f"scene={{mesh: {{file: {os.path.abspath('solid')}.obj, translate_m: [0, 0, 300]}}}}")
ok(code == 2 and "no rock in the domain" in said, "plan refuses a scene of which nothing is left", code, said)
CONE = {"cylinder": {"from_m": [20, 15, 24], "to_m": [20, 15, 0], "radius_m": 10, "top_radius_m": 0.05}}
with open("job.json", "w") as file:
    json.dump({**GOOD, "scene": CONE, "cameras": {}}, file)
for command in (("check",), ("plan", "--rehearse", "0"), ("run", "--out", "cone")):
    code, said = hoodoo(command[0], "job.json", *command[1:])
    ok(code == 2 and "the lowest rock is at z =" in said, f"{command[0]} refuses a cone on its tip, which no voxel that is half full holds up", code, said)
with open("rock.ply", "w") as file:
    file.write("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0 1\n9 0 0 1\n0 9 0 1\n3 0 1 2\n")
code, said = check(edited("paint", [{"mesh_attribute": {"file": "rock.ply", "attribute": "rad"}, "erodibility": 2}]))
ok(code == 3 and "rad" in str(said) and "'red'" in str(said), "check reads the files of paint, and names the attributes of a mesh", code, said)
code, found = check(edited("strata", [{"to_m": 10}, {"to_m": 10.1}, {"to_m": 24}]))
place = found[0]["place"].split(":")
line = open("job.json").read().splitlines()[int(place[1]) - 1]
ok(place[0] == "job.json" and '"to_m"' in line and "10.1" in line, "a warning names the line where its key stands", found, line)
code, found = check({**GOOD, "wedge": {"over": [{"key": "domain.size_m", "values": [[40, 30, 30], [20, 30, 30]]}]}})
ok(code == 0 and [w.get("wedge") for w in found] == [2], "each wedge is looked at", found)
code, found = check(GOOD)
ok(code == 0 and found == [], "a sound job has nothing", found)
code, said = check(GOOD, "--strict")
ok(code == 0, "nor with --strict", said)
code, said = hoodoo("check", "job.json", "--set", "domain.size_m=[20, 30, 30]", "--strict")
ok(code == 2 and "cut off" in said, "--strict makes a warning an error", code, said)
# check also refuses what loading refuses, and scenes without supported rock.
for job, words in [(edited("cameras/Main", GOOD["cameras"]["main"]), "case only"), (edited("wind", {"sped_m_s": 3}), "speed_m_s"), (edited("scene", {"box": {"min_m": [8, 8, 5], "max_m": [32, 22, 24]}}), "ground"),
                   (edited("scene", {"box": {"min_m": [100, 8, 0], "max_m": [132, 22, 24]}}), "no rock")]:
    code, said = check(job)
    ok(code == 2 and words in str(said), f"refused: {words}", code, said)
# A job that is a link finds its files beside the link, or else beside its target.
os.makedirs("shot/real", exist_ok=True)
obj("shot/real/rock.obj", (*OUTER, False))
with open("shot/real/linked.json", "w") as file:
    json.dump({**GOOD, "scene": {"mesh": {"file": "rock.obj"}}, "wedge": {"csv": "wedges.csv"}}, file)
with open("shot/real/wedges.csv", "w") as file:
    file.write("seed\n1\n2\n")
os.symlink("real/linked.json", "shot/job.json")
code, said = hoodoo("check", "shot/job.json")
ok(code == 0 and "shot/real/rock.obj: 8064 m3" in said and "the link refers to" in said, "a link's files are beside the job itself, and that is said", said)
obj("shot/rock.obj", (*INNER, False))
code, said = hoodoo("check", "shot/job.json", "--set", "scene.mesh.translate_m=[0, 0, -4]")
ok(code == 0 and "shot/rock.obj: 1536 m3" in said, "unless they are beside the link", said)
for name, text, words in (("semi", b"seed;fps\n1;24\n", "semicolons"), ("tabs", b"seed\tfps\n1\t24\n", "tabs"), ("wide", "seed,fps\n1,24\n".encode("utf-16"), "UTF-16")):
    with open(name + ".csv", "wb") as file:
        file.write(text)
    code, said = check({**GOOD, "wedge": {"csv": name + ".csv"}})
    ok(code == 3 and words in said, f"a CSV of {words} is named as that", code, said)
with open("comma.csv", "w") as file:
    file.write("seed,fps\n1,24\n2,")
code, said = check({**GOOD, "wedge": {"csv": "comma.csv"}})
ok(code == 3 and "comma.csv:3: fps is empty" in said, "a CSV that ends in a comma lacks a value", code, said)
for path in sorted(glob.glob(os.path.join(TOP, "jobs/*.yaml"))):
    code, said = hoodoo("check", path)
    ok(code == 0 and "no problems found" in said, os.path.basename(path) + " has no warning", said)
began = os.times()
hoodoo("check", os.path.join(TOP, "jobs/demo.yaml"))
ended = os.times()
cpu = ended.children_user + ended.children_system - began.children_user - began.children_system
ok(cpu < 0.15, f"the demo is checked in {1000 * cpu:.0f} ms of CPU")
finish()

"""The dimensionless groups that `hoodoo plan` lists: values computed by hand, sentences, and the examples lie within the ranges given for them."""

import glob
import json
import math
import os
import sys

from script import TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = {
    "hoodoo": 1, "name": "block", "frames": "1-51", "clock": {"years_per_frame": 1000}, "domain": {"size_m": [40, 30, 40], "spacing_m": 1},
    "rock": {"density_kg_m3": 2000, "gravity_m_s2": 10}, "scene": {"box": {"min_m": [5, 5, 0], "max_m": [35, 25, 30]}},
    "strata": [{"weak_m_per_kyr": 0.2, "strong_m_per_kyr": 0.002, "interlock_MPa": 0.3}], "wind": {"abrasion": 0.4, "speed_m_s": 5},
    "rain": {"m_per_yr": 0.5, "threshold_Pa": 2, "pull_Pa": 0.5},
}


def groups(job, *options):
    code, said = hoodoo("plan", job, "--json", "--device", "none", *options)
    answer = json.loads(said[said.index("{"):]) if code == 0 else {}
    return {g["group"]: g for g in answer.get("groups", [])} or said


with open("job.json", "w") as file:
    json.dump(JOB, file)
found = groups("job.json")
# Half a spacing less at each side: bounds are those of the particles' centres.
HEIGHT, HALF = 29, 9.5
BY_HAND = {
    "interlocking": 0.3 / (2000 * 10 * HEIGHT / 1e6), "retreat": 0.2 * 50 / HALF, "endurance": 0.002 * 50 / HALF, "deflation": 0.75 * 0.02 * HEIGHT,
    "abrasion": 0.4 * 0.25, "water": 0.5 * (0.5 * 2 * HALF) ** 0.6 / 2,
}
for name, value in BY_HAND.items():
    ok(name in found and math.isclose(found[name]["value"], value, rel_tol=0.01), f"{name} is {value:.3g}", found)
steep = (1 / BY_HAND["water"]) ** (1 / 0.7)
ok(f"steeper than {steep:.2g} " in found["water"]["says"], "the slope from which on water cuts", steep, found["water"])
ok("from 15 m of rock upwards, of 29 m: arches and pillars hold" in found["interlocking"]["says"], "rock enough to interlock", found["interlocking"])
found = groups("job.json", "--set", "strata_scale.interlock={1: 1, 51: 5}")
ok(math.isclose(found["interlocking"]["value"], 3 * BY_HAND["interlocking"], rel_tol=0.01) and "from 45 m of rock upwards; nothing in this scene is that high" in
   found["interlocking"]["says"], "a factor on all strata, in the middle frame", found["interlocking"])
found = groups("job.json", "--set", "rain.threshold_Pa=2000")
ok("cuts nothing" in found["water"]["says"], "water that cuts nothing", found["water"])
found = groups("job.json", "--set", "model=goblins", "--set", "strata.0.bubble.radius_m=2")
ok(set(found) == {"retreat", "bubble"} and math.isclose(found["bubble"]["value"], 2 / HALF, rel_tol=0.01), "goblins: bubbles", found)
code, said = hoodoo("plan", "job.json", "--device", "none")
ok(code == 0 and "I / (density g H)" in said and "arches and pillars hold" in said, "in words", said)
seen = 0
for path in sorted(glob.glob(f"{TOP}/jobs/*.yaml")):
    found = groups(path)
    if not isinstance(found, dict):
        continue
    seen += 1
    # In these, water makes the form and the rock hardly weathers, or hollows are to be small.
    but = {"slot_canyon": {"retreat"}, "tafoni": {"interlocking", "endurance"}, "fins": {"interlocking"}, "mushroom": {"interlocking"}}.get(os.path.basename(path)[:-5], set())
    outside = {name for name, g in found.items() if g["value"] < g["forms_from"] or g["forms_to"] and g["value"] > g["forms_to"]}
    ok(outside == but, f"{os.path.basename(path)} is within the ranges", outside, found)
ok(seen > 15, "most examples have groups", seen)
finish()

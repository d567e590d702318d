"""strata_scale multiplies the rates and interlocking stresses of all strata, as if each were written so; paint without a place paints all rock."""

import json
import os
import sys

from script import finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = {
    "hoodoo": 1, "name": "rock", "frames": "1-4", "clock": {"years_per_frame": 2000}, "domain": {"size_m": [8, 8, 8], "spacing_m": 0.5},
    "scene": {"box": {"min_m": [2, 2, 0], "max_m": [6, 6, 7]}}, "noise": {"amplitude": 0.2, "scale_m": 3}, "checkpoint": {"every": 1, "keep": 9},
    "strata": [{"to_m": 3, "weak_m_per_kyr": 0.2, "strong_m_per_kyr": 0.02, "interlock_MPa": 0.15}, {"weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.01, "interlock_MPa": 0.1}],
}
TWICE = [{"to_m": 3, "weak_m_per_kyr": 0.4, "strong_m_per_kyr": 0.04, "interlock_MPa": 0.075}, {"weak_m_per_kyr": 0.2, "strong_m_per_kyr": 0.02, "interlock_MPa": 0.05}]


def run(out, **more):
    """The states of all frames, and the volume in the last."""
    with open("job.json", "w") as file:
        json.dump({**JOB, **more}, file)
    code, said = hoodoo("run", "job.json", "--out", out, "--progress", "none")
    if not ok(code == 0, f"{out} runs", said):
        return None, 0
    states = []
    for frame in range(1, 5):
        said = json.loads(hoodoo("inspect", f"{out}/checkpoint/rock.{frame:04}.ckpt", "--json")[1])
        states.append([(s["name"], s["hash"]) for s in said["sections"]])
    with open(f"{out}/frames/rock.0004.json") as file:
        return states, json.load(file)["statistics"]["volume_m3"]


volumes = {}
for model in ("arenite", "goblins"):
    plain, volume = run(model, model=model)
    volumes[model] = volume
    written, less = run(f"{model}-twice", model=model, strata=TWICE)
    scaled, same = run(f"{model}-scaled", model=model, strata_scale={"rates": 2, "interlock": 0.5})
    ok(plain and scaled == written and scaled != plain and same == less < volume, f"{model}: twice the rates of all strata", volume, less, same)
    late, between = run(f"{model}-late", model=model, strata_scale={"rates": {"3": 1, "4": 2, "ease": "step"}})
    ok(late and late[:3] == plain[:3] and less < between < volume, f"{model}: a curve", volume, between, less)
painted, less = run("painted", paint=[{"erodibility": 2, "interlock": 0.5}])
shaped, _ = run("shaped", paint=[{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [9, 9, 9]}}, "erodibility": 2, "interlock": 0.5}])
ok(painted and painted == shaped and less < volumes["arenite"], "paint without a place: all rock", less, volumes)
swept = {**JOB, "wedge": {"over": [{"key": "strata_scale.interlock", "values": [0.5, 1, 2]}]}}
with open("swept.json", "w") as file:
    json.dump(swept, file)
code, said = hoodoo("plan", "swept.json", "--json", "--device", "none")
ok(code == 0, "wedges over it", said)
code, said = hoodoo("check", "job.json", "--set", "paint=[{}]")
ok(code == 2 and "paints nothing" in said, "paint that changes nothing is refused", said)
code, said = hoodoo("check", "job.json", "--set", "strata_scale.interlock=10000", "--set", "strata.0.interlock_MPa=0.3")
ok(code == 0 and "no grains ever interlock" in said, "check sees the product", said)
finish()

"""What each process took of the rock (change_m3 in frames' manifests): the processes add up to the frame's change, each acts
where it should, and on a bare face wind and deflation share as their rates do."""
import json
import os
import subprocess
import sys

TOP, HOODOO = os.environ["HOODOO_TOP"], os.environ["HOODOO"]
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)


def run(name, job, *options):
    """The manifests, by frame."""
    if not isinstance(job, str):
        with open(name + ".json", "w") as file:
            json.dump({"hoodoo": 1, "name": "b", **job}, file)
        job = name + ".json"
    done = subprocess.run([HOODOO, "run", job, "--out", name, "--progress", "none", "--set", "output.aov.cameras=[]",
                           "--set", "output.vdb.points=none", "--set", "output.usd.points=none", *options],
                          capture_output=True, text=True)
    if done.returncode:
        check(False, f"{name}: {done.stderr.strip()}")
        sys.exit(1)
    return [json.load(open(f"{name}/frames/{f}")) for f in sorted(os.listdir(f"{name}/frames"))]


def adds_up(name, frames):
    """Largest error of the sum, against the change; and the sum over all frames by process."""
    worst, total, before = 0, {}, frames[0]["statistics"]["volume_m3"]
    check(not any(frames[0]["change_m3"].values()), f"{name}: nothing has changed in the first frame")
    for frame in frames[1:]:
        now = frame["statistics"]["volume_m3"]
        change = frame["change_m3"]
        worst = max(worst, abs(sum(change.values()) - (now - before)) / max(abs(now - before), 1e-6 * before))
        for process, m3 in change.items():
            total[process] = total.get(process, 0) + m3
        before = now
    said = ", ".join(f"{k} {v:.4g}" for k, v in total.items() if v)
    check(worst < 1e-6, f"{name}: the processes add up to the change, within {worst:.1e} of it ({said} m3)")
    return total


SLAB = {"frames": "1-4", "clock": {"years_per_frame": 900}, "domain": {"size_m": [12, 10, 8], "spacing_m": 0.5},
        "scene": {"box": {"min_m": [2, 2, 0], "max_m": [10, 8, 6]}},
        "strata": [{"weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.1, "interlock_MPa": 1000}]}
# So strong a pull that stress does not matter.
CALM = {"strength_MPa": 1000}

t = adds_up("wind", run("wind", TOP + "/tests/restart/twelve.yaml"))
check(t["deflation"] < 0 and t["abrasion"] < 0 and t["blocks"] < 0 and t["water"] == t["edits"] == t["deposition"] == t["collapse"] == 0,
      "wind: deflation, abrasion and blocks act, nothing else")
t = adds_up("still", run("still", {**SLAB, "wind": {"abrasion": 0}}))
check(t["deflation"] < 0 and t["abrasion"] == 0, "no abrasion: all of it is deflation's")
t = adds_up("sand", run("sand", {**SLAB, "wind": {"deflation": {"intensity": 0}, "shelter_m": 0}}))
check(t["abrasion"] < 0 and t["deflation"] == 0, "no deflation: all of it is abrasion's")
# While no particle is gone yet, intensities add: each process takes what it takes alone.
wind = {"direction": [1, 0, -1], "abrasion": 0.5, "deflation": CALM}
young = {**SLAB, "frames": "1-2", "clock": {"years_per_frame": 200}}
both = adds_up("both", run("both", {**young, "wind": wind}))
sand = adds_up("sand alone", run("sand_alone", {**young, "wind": {**wind, "deflation": {"intensity": 0}}}))
calm = adds_up("plucking alone", run("plucking_alone", {**young, "wind": {**wind, "abrasion": 0}}))
rates = {"abrasion": both["abrasion"] / sand["abrasion"] - 1, "deflation": both["deflation"] / calm["deflation"] - 1}
check(max(map(abs, rates.values())) < 1e-3 and sand["abrasion"] < 0.05 * calm["deflation"] < 0,
      f"wind and deflation together take what they take alone (off by {rates['abrasion']:.1e} and {rates['deflation']:.1e})")
t = adds_up("river", run("river", {
    **SLAB, "scene": {"plane": {"point_m": [6, 5, 4], "normal": [-0.3, 0.1, 1]}}, "wind": {"abrasion": 0, "deflation": {"intensity": 0}},
    "rain": {"m_per_yr": 0.5, "erosion": 20, "threshold_Pa": 0.05}, "sources": [{"path_m": [[10, 5, 7]], "m3_per_yr": 200}]}))
check(t["water"] < 0 and t["abrasion"] == t["deflation"] == 0, "no wind: all of it is water's")
t = adds_up("deposits", run("deposits", {
    **SLAB, "clock": {"years_per_frame": 2500}, "domain": {"size_m": [20, 20, 10], "spacing_m": 0.5},
    "scene": {"union": [{"box": {"min_m": [7, 7, 0], "max_m": [13, 13, 8]}}, {"box": {"min_m": [-1, -1, 0], "max_m": [21, 21, 1], "inert": True}}]},
    "deposition": {"viability": 0.3}, "rain": {"m_per_yr": 0.3, "erosion": 5, "threshold_Pa": 0.05}}))
check(t["deposition"] > 0 and t["water"] < 0 and t["deflation"] < 0 and t["abrasion"] < 0, "deposits: they add rock")
t = adds_up("edits", run("edits", TOP + "/tests/restart/edits.yaml"))
check(t["edits"] > 0, "edits: those that add rock outweigh those that carve")
t = adds_up("fall", run("fall", TOP + "/tests/restart/twelve.yaml", "--set", "collapse.blocks=fall", "--frames", "1001-1004"))
check(t["blocks"] <= 0, "blocks that fall: some leave as crumbs")
t = adds_up("goblins", run("goblins", {**SLAB, "model": "goblins", "scene": {"cylinder": {"from_m": [6, 5, 0], "to_m": [6, 5, 7], "radius_m": 3}},
                                       "strata": [{"to_m": 3, "weak_m_per_kyr": 0.8}, {"weak_m_per_kyr": 0.1}]}))
check(t["weathering"] < 0, "goblins: weathering")
sys.exit(failed)

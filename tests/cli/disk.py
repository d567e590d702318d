"""`hoodoo plan` predicts the disk space of a run within a factor of 1.5 for all output settings, and every key changes the prediction in the
right direction."""
import json
import os
import subprocess
import sys

HOODOO, TOP = os.environ["HOODOO"], os.environ["HOODOO_TOP"]
FACTOR = 1.5
failed = False


def check(good, what):
    global failed
    failed |= not good
    print(("ok " if good else "not ok ") + what)


def hoodoo(*words):
    done = subprocess.run([HOODOO, *words], capture_output=True, text=True)
    if done.returncode:
        check(False, " ".join(words) + ": " + done.stderr.strip())
        sys.exit(1)
    return done.stdout


JOB = os.path.join(TOP, "tests/restart/twelve.yaml")
# Planned and run jobs must be the same, so a run of fewer frames has another name.
with open(JOB) as file:
    text = file.read().replace("1001-1012", "1001-1004").replace("spacing_m: 0.5", "spacing_m: 0.3").replace("[96, 54]", "[240, 135]")
with open("job.yaml", "w") as file:
    file.write(text)
WATER = """hoodoo: 1
name: brook
frames: 1-4
clock: {years_per_frame: 200}
domain: {size_m: [14, 12, 9], spacing_m: 0.3}
scene: {union: [plane: {point_m: [7, 6, 4], normal: [-0.3, 0.1, 1]}, box: {min_m: [9, 2, 3], max_m: [12, 10, 8]}]}
strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.002}]
rain: {m_per_yr: 0.5, erosion: 20, threshold_Pa: 0.05}
cameras: {main: {orbit: {target_m: [7, 6, 4], distance_m: 20}, resolution: [200, 200]}}
output: {aov: {cameras: [main]}}
checkpoint: {every: 2}
"""
with open("water.yaml", "w") as file:
    file.write(WATER)


def kind(path):
    folder = path.split("/")[0]
    return {"points": "usd" if path.endswith(".usdc") else "points", "volumes": "volumes", "aov": "pictures"}.get(folder, "other")


def measure(name, job, sets):
    """Planned and written bytes, in total and by kind."""
    words = [w for s in sets for w in ("--set", s)]
    plan = json.loads(hoodoo("plan", job, "--rehearse", "0", "--json", *words))
    hoodoo("run", job, "--out", name, "--progress", "none", *words)
    written = {"points": 0, "usd": 0, "volumes": 0, "pictures": 0}
    for manifest in os.listdir(f"{name}/frames"):
        for file in json.load(open(f"{name}/frames/{manifest}"))["files"]:
            written[kind(file["path"])] = written.get(kind(file["path"]), 0) + file["size"]
    written["checkpoints"] = sum(os.path.getsize(f"{name}/checkpoint/{f}") for f in os.listdir(f"{name}/checkpoint"))
    whole = sum(os.path.getsize(os.path.join(at, f)) for at, _, files in os.walk(name) for f in files if "/log" not in at)
    return plan, written, whole


V = "output.vdb."
VARIANTS = {  # the setting, and the kinds that it makes smaller (-) or larger (+) than in `plain`
    "plain": ([], {}),
    "16 bit": ([V + "precision=16bit"], {"points": -1}),
    "uncompressed": ([V + "codec=none"], {"points": 1, "volumes": 1}),
    "uncompressed, 16 bit": ([V + "codec=none", V + "precision=16bit"], {"points": 1, "volumes": 1}),
    "zip": ([V + "codec=zip"], {"points": 1, "volumes": 1}),
    "half": ([V + "half=true"], {"volumes": -1}),
    "surface": ([V + "points=surface"], {"points": -1}),
    "surface, 16 bit": ([V + "points=surface", V + "precision=16bit"], {"points": -1}),
    "no points": ([V + "points=none"], {"points": -1}),
    "no USD": (["output.usd.points=none"], {"usd": -1}),
    "every second": ([V + "every=2"], {"points": -1, "usd": -1, "volumes": -1}),
    "points every third": ([V + "points_every=3"], {"points": -1, "usd": -1}),
    "pictures every second": (["output.aov.every=2"], {"pictures": -1}),
    "four layers": (["output.aov.layers=[rgba, depth, N, stress]"], {"pictures": -1}),
    "mattes": (["output.aov.cryptomatte=true"], {"pictures": 1}),
    "no pictures": (["output.aov.cameras=[]"], {"pictures": -1}),
    "z up": (["output.up=z"], {}),
    "kept": (["checkpoint.every=1", "checkpoint.keep=4"], {"checkpoints": 1}),
}
plain = None
for name, (sets, moves) in VARIANTS.items():
    plan, written, whole = measure(name.replace(" ", "_").replace(",", ""), "job.yaml", sets)
    ratio = plan["disk_bytes"] / whole
    planned = {k: plan["disk"][k + "_bytes"] for k in ("points", "usd", "volumes", "pictures", "checkpoints")}
    plain = plain or (planned, written)
    parts = ", ".join(f"{k} {planned[k] / written[k]:.2f}" for k in planned if written[k])
    check(1 / FACTOR < ratio < FACTOR, f"{name}: {plan['disk_bytes'] / 1e6:.2f} MB planned, {whole / 1e6:.2f} MB written ({ratio:.2f}; {parts})")
    check(all((planned[k] == 0) == (written[k] == 0) for k in planned), f"{name}: planned what is written, and nothing else")
    for k in planned:
        way = moves.get(k, 0)
        check((planned[k] - plain[0][k]) * way > 0 and (written[k] - plain[1][k]) * way > 0 if way else planned[k] == plain[0][k],
              f"{name}: {k} {'grow' if way > 0 else 'shrink' if way < 0 else 'stay as they were'}")
for name, job, sets in (("water", "water.yaml", []), ("goblins", TOP + "/tests/restart/twelve.yaml",
                                                      ["model=goblins", "domain.spacing_m=0.25", "frames=1001-1003"])):
    plan, written, whole = measure(name, job, sets)
    planned = {k: plan["disk"][k + "_bytes"] for k in ("points", "usd", "volumes", "pictures", "checkpoints")}
    parts = ", ".join(f"{k} {planned[k] / written[k]:.2f}" for k in planned if written[k])
    ratio = plan["disk_bytes"] / whole
    check(1 / FACTOR < ratio < FACTOR, f"{name}: {plan['disk_bytes'] / 1e6:.2f} MB planned, {whole / 1e6:.2f} MB written ({ratio:.2f}; {parts})")
sys.exit(failed)

"""What water takes does not depend on spacing, years a frame or direction, on slopes and rivers that are drawn from one number. Where
a river falls off the rock it takes more across the grid than along it.

    any_water.py [NUMBER [COUNT]]     from this number on, so many, with HOODOO, HOODOO_TOP and tests/lib in PYTHONPATH, as tests/run.sh sets them
"""
import glob
import json
import math
import os
import random
import sys
import tempfile

import script

YEARS, SIDE = 8000, 30


def job(draw, spacing, years, degrees):
    a, middle = math.radians(degrees), SIDE / 2
    slope = f"{{plane: {{point_m: [{middle}, {middle}, 10], normal: [{draw['slope'] * math.cos(a):.5f}, {draw['slope'] * math.sin(a):.5f}, 1]}}}}"
    pillar = f"{{cylinder: {{from_m: [{middle}, {middle}, 0], to_m: [{middle}, {middle}, 20], radius_m: {middle - 4}}}}}"
    lines = [
        f"hoodoo: 1\nname: any\nframes: 1-{1 + YEARS // years}\nseed: {draw['seed']}\nclock: {{years_per_frame: {years}}}",
        f"domain: {{size_m: [{SIDE}, {SIDE}, 18], spacing_m: {spacing}}}\nrock: {{gravity_m_s2: 0}}",
        f"scene: {{intersection: [{pillar}, {slope}]}}",
        "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.2}]\nwind: {abrasion: 0, deflation: {intensity: 0}}",
        f"rain: {{m_per_yr: {draw['rain']}, erosion: {draw['erosion']}, threshold_Pa: {draw['threshold']}}}",
    ]
    if draw["river"]:
        ends = [[middle + s * (middle - 6) * math.cos(a), middle + s * (middle - 6) * math.sin(a), 10.3 - s * (middle - 6) * draw["slope"]] for s in (-1, 1)]
        path = ", ".join(f"[{x:.3f}, {y:.3f}, {z:.3f}]" for x, y, z in ends)
        lines.append(f"sources: [{{path_m: [{path}], m3_per_yr: {draw['river']}, bed_m: 2}}]")
    return "\n".join(lines + ["output: {vdb: {points: none, every: 1000}, usd: {points: none}}\ncheckpoint: {every: 1000}\n"])


def taken(*what):
    with tempfile.TemporaryDirectory() as folder:
        path, out = os.path.join(folder, "any.yaml"), os.path.join(folder, "out")
        with open(path, "w") as file:
            file.write(job(*what))
        code, said = script.hoodoo("run", path, "--out", out, "--progress", "none")
        if code:
            sys.exit(said)
        m3 = 0
        for name in glob.glob(out + "/frames/*.json"):
            with open(name) as file:
                m3 -= json.load(file)["change_m3"]["water"]
        return m3


def drawn(number):
    """Water that lowers the foot of the slope by one to two metres."""
    r = random.Random(number)
    draw = {"slope": r.uniform(0.15, 0.6), "rain": r.uniform(0.3, 2), "seed": r.randrange(1000), "river": 0}
    if r.random() < 0.4:
        draw.update(rain=0, river=r.uniform(5e3, 1e5))
    q = draw["river"] / 3 if draw["river"] else draw["rain"] * (SIDE - 8)
    pull = 0.12 * q**0.6 * draw["slope"] ** 0.7
    draw["threshold"] = r.choice([0, 0, r.uniform(0.2, 0.6)]) * pull
    draw["erosion"] = r.uniform(1, 2) / (0.2 * YEARS / 1000) / (pull - draw["threshold"])
    fine = r.choice([0.5, 0.6, 0.75, 1])
    return draw, fine, r.choice([1.5, 2]) * fine, r.choice([500, 800, 1000]), r.uniform(0, 360), r.uniform(0, 360)


def check(number):
    draw, fine, coarse, years, one, other = drawn(number)
    base = taken(draw, fine, 2000, one)
    said = ", ".join(f"{k} {v:.3g}" for k, v in draw.items())
    for what, m3, bound in (
        (f"spacing {coarse:g} m instead of {fine:g}", taken(draw, coarse, 2000, one), 1.2),
        (f"{years} years a frame instead of 2000", taken(draw, fine, years, one), 1.15),
        (f"to {other:.0f} degrees instead of {one:.0f}", taken(draw, fine, 2000, other), 1.15 if draw["river"] else 1.1),
    ):
        script.ok(max(base, m3) <= bound * min(base, m3), f"{number}: {what}: {base:.1f}, {m3:.1f} m3", said)


first = int(sys.argv[1]) if len(sys.argv) > 1 else 1
for number in range(first, first + (int(sys.argv[2]) if len(sys.argv) > 2 else 1)):
    check(number)
script.finish()

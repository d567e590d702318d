"""hoodoo look --cut: cuts show what is inside of the rock, on pictures and on the page."""
import json
import shutil
import sys

from looking import Page, look, png_size, write
from script import TOP, finish, ok

sys.dont_write_bytecode = True

# A cut shows the inside, which has no particles until it is cut. Their values are those of rock that has particles everywhere.
CUT = """hoodoo: 1
name: cut
frames: 1001-1002
clock: {years_per_frame: 500}
domain: {size_m: [24, 20, 24], spacing_m: 0.5}
scene: {box: {min_m: [2, 2, 0], max_m: [22, 18, 22]}}
strata:
  - {to_m: 6, weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}
  - {to_m: 13, weak_m_per_kyr: 0.4, strong_m_per_kyr: 0.04, interlock_MPa: 0.2}
  - {weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 0.2}
wind: {direction: [1, 0, 0], speed_m_s: 10, abrasion: 0.5, flow: {solver: uniform}}
cameras: {main: {orbit: {target_m: [12, 10, 11], distance_m: 60, azimuth_deg: -70, elevation_deg: 12}, resolution: [160, 120]}}
"""
write(CUT, "cut.yaml")
shown = {}
for value, words in [("stress", ()), ("layer", ()), ("rock", ("--gizmos", "none")), ("whole", ())]:
    own = ("--spacing", "0.5", *words) + (("--show", value, "--cut", "y=10") if value != "whole" else ())
    code, made = look("cut.yaml", "--out", "cut.png", *own)
    shown[value] = open("cut.png", "rb").read() if ok(code == 0, f"a cut through {value}", made) else b""
    if value in ("stress", "layer"):
        code, made = look("cut.yaml", "--out", "cut.png", "--set", "domain.particles=all", *own, cache="all")
        ok(code == 0 and open("cut.png", "rb").read() == shown[value], f"a cut through {value}: as if all rock had particles", made)
ok(len(set(shown.values())) == 4, "cuts differ from each other and from the whole")
shutil.copy(f"{TOP}/jobs/goblin_cap.png", ".")
write(open(f"{TOP}/jobs/goblin_cap.yaml").read(), "goblin.yaml")
write(open(f"{TOP}/jobs/arches_cave.yaml").read(), "cave.yaml")
for model, job, words in [("arches", "cave.yaml", ("--spacing", "4", "--frame", "1001", "--cut", "z=20", "--show", "layer")), ("goblins", "goblin.yaml", ("--frame", "1001", "--cut", "y=3.5"))]:
    code, made = look(job, "--out", "cut.png", *words)
    ok(code == 0 and png_size("cut.png"), f"{model}: a cut", made)

write(open(f"{TOP}/tests/restart/edits.yaml").read())
for at, sentence in [("x=14.1", "x is 0 to 14 m"), ("y=-1", "y is 0 to 14 m"), ("w=3", "such as x=12.5"), ("x=1m", "such as x=12.5"), ("x=nan", "0 to 14 m"), ("x=", "such as x=12.5")]:
    code, said = look("edits.yaml", "--cut", at)
    ok(code == 2 and sentence in str(said), f"--cut {at}: exit 2", code, said)

page = Page("edits.yaml")
# On a cut, places are in its plane, and stress grows with depth; beds change at their heights.
code, _, note, body = page.fetch("/picture", token=page.token, frame=1001, show="layer", cut="y=7", camera="-90,5")
ok(code == 200 and json.loads(note)["legend"]["ticks"], "a cut, with the legend of what it shows", note)
places = [page.json("/at", x=0.5, y=y / 100) for y in range(5, 95, 5)]
rock = [p for p in places if p["rock"] and p["P.Z"] < 7]
ok(len(rock) > 3 and all(abs(p["P.Y"] - 7) < 1e-4 and abs(p["N.Y"] + 1) < 1e-6 for p in rock), "places on the cut", places)
ok(all(p["layer.id"] == (p["P.Z"] > 4) for p in rock if abs(p["P.Z"] - 4) > 0.3) and {p["layer.id"] for p in rock} == {0, 1}, "beds on the cut", rock)
deeper = [p["stress.trace"] for p in sorted(rock, key=lambda p: -p["P.Z"])]
ok(all(a < b for a, b in zip(deeper, deeper[1:])) and deeper[0] > 0, "stress on the cut", deeper)
code, _, _, body = page.fetch("/picture", token=page.token, cut="y=70")
ok(code == 422 and b"0 to 14 m" in body, "a cut beside the domain", code, body)
finish()

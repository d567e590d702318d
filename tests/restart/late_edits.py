"""Jobs edited between two runs into one folder. Keys that affect no frame are adopted; changes of how frames are written, or of the first
frame, are refused with the key. A folder never contains frames of two kinds."""
import json
import os
import sys

from script import finish, hoodoo, ok

sys.dont_write_bytecode = True
JOB = {
    "hoodoo": 1, "name": "late", "frames": "1001-1003", "clock": {"years_per_frame": 500},
    "domain": {"size_m": [12, 12, 12], "spacing_m": 1}, "scene": {"box": {"min_m": [3, 3, 0], "max_m": [9, 9, 8]}},
    "strata": [{"weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.1}],
    "cameras": {"main": {"orbit": {"target_m": [6, 6, 4], "distance_m": 20}, "resolution": [32, 18]},
                "spare": {"orbit": {"target_m": [6, 6, 4], "distance_m": 30}, "resolution": [32, 18]}},
    "output": {"aov": {"cameras": ["main"]}},
}
UP = {"orbit": {"target_m": [6, 6, 4], "distance_m": 20, "elevation_deg": 80}, "resolution": [32, 18]}


def merged(job, edit):
    out = dict(job)
    for key, value in edit.items():
        out[key] = merged(job[key], value) if isinstance(value, dict) and isinstance(job.get(key), dict) else value
    return out


def run(edit, *options, out="out"):
    with open("late.json", "w") as file:
        json.dump(merged(JOB, edit), file)
    return hoodoo("run", "late.json", "--out", out, "--progress", "none", *options)


def frames():
    return {f: open(f"out/frames/{f}", "rb").read() for f in sorted(os.listdir("out/frames"))}


code, said = run({}, "--frames", "1001-1002")
ok(code == 0, "two frames of three", said)
before = frames()
REFUSED = {
    "output.up": {"output": {"up": "z"}},
    "output.vdb.codec": {"output": {"vdb": {"codec": "zip"}}},
    "output.vdb.points": {"output": {"vdb": {"points": "surface"}}},
    "output.usd.points": {"output": {"usd": {"points": "none"}}},
    "output.aov.samples": {"output": {"aov": {"samples": 2}}},
    "output.aov.cameras": {"output": {"aov": {"cameras": ["main", "spare"]}}},
    "output.owner": {"output": {"owner": "somebody"}},
    "cameras.main.orbit.distance_m": {"cameras": {"main": {"orbit": {"target_m": [6, 6, 4], "distance_m": 21}}}},
    "cameras.main.focal_mm": {"cameras": {"main": {"focal_mm": 50}}},
    "fps": {"fps": 25},
    "strata.0.color": {"strata": [{"weak_m_per_kyr": 0.1, "strong_m_per_kyr": 0.1, "color": [1, 0, 0]}]},
    "strata.0.weak_m_per_kyr": {"strata": [{"weak_m_per_kyr": 0.2, "strong_m_per_kyr": 0.1}]},
    "domain.spacing_m": {"domain": {"spacing_m": 0.5}},
    "seed": {"seed": 2},
}
for key, edit in REFUSED.items():
    code, said = run(edit)
    ok(code == 7 and key in said and "--out" in said, f"another {key} is refused, and named", code, said)
code, said = run({"output": {"up": "z"}}, "--frames", "1003-1003")
ok(code == 7 and "output.up" in said and "1001-1002" in said, "also where only later frames are asked for", said)
code, said = run({"frames": "998-1003"})
ok(code == 7 and "1001" in said and "998" in said, "head handles are refused: ages count from the first frame", said)
code, said = run({"frames": "1002-1004"})
ok(code == 7 and "1002" in said, "a later first frame, too", said)
code, said = hoodoo("submit", "late.json", "--to", "openjd", "--out", "out")
ok(code == 7, "submit refuses what the tasks would", said)
ok(frames() == before, "no refused edit touched a frame")
code, said = run({"output": {"up": "z"}}, out="other")
ok(code == 0, "another folder takes it", said)

code, said = run({"cameras": {"top": UP}, "checkpoint": {"every": 2}, "farm": {"turntable": 8}})
ok(code == 0 and len(frames()) == 3, "a camera, checkpoints and farm keys may come between two runs", said)
ok(all(frames()[f] == before[f] for f in before), "and leave the frames that are there alone")
code, said = run({"cameras": {"top": UP, "side": {"position_m": [30, 6, 4], "target_m": [6, 6, 4], "resolution": [32, 18]}}})
ok(code == 0 and "done already" in said, "a camera may come when all is done", said)
code, said = hoodoo("aov", "out", "--camera", "side", "--frames", "1003", "--progress", "none")
ok(code == 0 and os.path.exists("out/aov/late.side.1003.exr"), "and takes pictures then", said)
ok('"side"' in open("out/late.usda").read(), "and is in the stage")
code, said = run({"cameras": {"side": {"position_m": [30, 6, 4], "target_m": [6, 6, 4], "resolution": [32, 18]}}, "frames": "1001-1004"})
ok(code == 0 and len(frames()) == 4, "frames may come at the end", said)
code, said = hoodoo("verify", "out")
ok(code == 0, "verify finds one kind of frames", said)
manifest = open("other/frames/late.1002.json", "rb").read()
with open("out/frames/late.1002.json", "wb") as file:
    file.write(manifest)
code, said = hoodoo("verify", "out")
ok(code == 3 and "late.1002.json" in said and "settings" in said, "a frame that was written otherwise is named", code, said)
code, said = run({}, "--resume", "never")
ok(code == 0, "starting over", said)
code, said = hoodoo("verify", "out", "--json")
left = {problem["file"] for problem in json.loads(said[:said.rindex("}") + 1])["problems"]}
ok(code == 3 and left and all(".1004." in path or path.startswith("aov/late") for path in left), "what the run before left is named", code, left)
for path in left:
    os.remove("out/" + path)
ok(hoodoo("verify", "out")[0] == 0, "and all else is alike", hoodoo("verify", "out"))
finish()

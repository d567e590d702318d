"""hoodoo keys, hoodoo new, and the JSON Schema for editors."""
import glob
import json
import os
import re
import sys

from script import TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True

code, all_of_them = hoodoo("keys")
ok(code == 0 and "wind:" in all_of_them and "shapes of scene: box" in all_of_them, "the sections and shapes", all_of_them)
pages = {what: hoodoo("keys", what) for what in ("wind", "wind.flow", "strata", "box", "union", "arches", "output.vdb", "cameras.main.orbit", "sources.0")}
ok(all(c == 0 for c, _ in pages.values()), "every section has a page", {w: c for w, (c, _) in pages.items()})
wide = [line for _, text in pages.values() for line in (text + all_of_them).splitlines() if len(line) > 80]
ok(not wide, "no line is longer than 80 columns", *wide)
# Every name in the output can be given to the command in the same form.
paths = sorted({line for _, text in pages.values() for line in text.splitlines() if re.fullmatch(r"[a-z]+(\.[A-Za-z0-9_]+)+", line)})
bad = [p for p in paths if hoodoo("keys", p)[1].splitlines()[0] != p]
ok(len(paths) > 50 and not bad, f"{len(paths)} keys of those pages, one by one", bad)
for asked, want in {"wind.speed_m_s": ("curve, m/s", "0 .."), "strata.3.interlock_MPa": ("MPa",), "scene.union.0.box.min_m": ("required",), "seed": ("default 1",)}.items():
    code, said = hoodoo("keys", asked)
    ok(code == 0 and said.startswith(asked + "\n") and all(w in said for w in want), f"{asked}: type, unit, default, range, meaning", said)
code, said = hoodoo("keys", "shear")
ok(code == 0 and "rock.shear_GPa" in said, "a word finds the keys that speak of it", said)
for wrong, near in {"wind.sped_m_s": "wind.speed_m_s", "vegetatoin": "vegetation"}.items():
    code, said = hoodoo("keys", wrong)
    ok(code == 2 and near in said, f"{wrong}: nearest is {near}", said)
code, said = hoodoo("keys", "qqqqqqqq")
ok(code == 2 and "qqqqqqqq" in said, "what no key speaks of is refused", said)

code, said = hoodoo("keys", "--schema")
schema = json.loads(said)
ok(code == 0 and schema["$defs"]["wind"]["additionalProperties"] is False and schema["$defs"]["box"]["required"] == ["min_m", "max_m"], "a JSON Schema")
ok(said == open(os.path.join(TOP, "jobs/schema.json")).read(), "jobs/schema.json is that")

code, listed = hoodoo("keys", "--list")
paths = listed.split()
ok(code == 0 and len(paths) == len(set(paths)) and {"arches.piles.rock_m", "edits.N.paint.N.erodibility", "edits.N.frame", "farm.finish.cpus", "scene.box.min_m"} <= set(paths),
   "every key is listed, in each section that has it", len(paths))
code, listed = hoodoo("new", "--list")
examples = [line for line in listed.splitlines() if line and not line.startswith(" ")]
ok(code == 0 and {"demo", "butte", "canyon", "arches_cave", "goblin_cube"} <= set(examples), "examples are listed", listed)
bad = []
for i, name in enumerate(examples):
    made, said = hoodoo("new", f"mine_{i}", "--like", name)
    text = open(f"mine_{i}.yaml").read() if made == 0 else ""
    planned = hoodoo("plan", f"mine_{i}.yaml", "--device", "none", "--json", "--set", f"domain.spacing_m={float(re.search(r'size_m: *[[]([0-9.]+)', text)[1]) / 40}")
    if made or f"\nname: mine_{i}\n" not in text or "schema" in text or f"jobs/{name}" in text or planned[0] or json.loads(planned[1])["name"] != f"mine_{i}":
        bad.append((name, said, planned))
ok(not bad, f"each of {len(examples)} makes a job under a new name that can be planned", *bad)
code, said = hoodoo("new", "mine_0")
ok(code == 2 and "already exists" in said, "a job that is there is not written over", said)
for words in (("new",), ("new", "a b"), ("new", "../x"), ("new", "x", "--like", "buttle")):
    code, said = hoodoo(*words)
    ok(code == 2, "refused: " + " ".join(words), said)
ok(not glob.glob("x*"), "and leaves nothing")
finish()

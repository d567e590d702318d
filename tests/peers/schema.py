"""The schema that editors check jobs by, as a validator of JSON Schema reads it: it takes every job that hoodoo takes, and refuses what hoodoo
refuses for a key or a value."""
import os
import subprocess
import sys

from script import HOODOO, TOP, finish, hoodoo, ok

sys.dont_write_bytecode = True
CHECK = [os.path.join(TOP, "build/venv-usd/bin/check-jsonschema")]
code, said = hoodoo("keys", "--schema")
with open("schema.json", "w") as file:
    file.write(said)


def refused(paths):
    """Those of the files that do not fit the schema."""
    done = subprocess.run([*CHECK, "--schemafile", "schema.json", "--output-format", "json", *paths], capture_output=True, text=True)
    return {path for path in paths if path in done.stdout}, done


done = subprocess.run([*CHECK, "--check-metaschema", "schema.json"], capture_output=True, text=True)
ok(done.returncode == 0, "it is a JSON Schema", done.stdout, done.stderr)
jobs = [os.path.join(root, name) for folder in ("jobs", "tests") for root, _, names in os.walk(os.path.join(TOP, folder)) for name in names
        if name.endswith(".yaml") and "hoodoo: 1" in open(os.path.join(root, name)).read()]
bad, done = refused(jobs)
good = [path for path in jobs if subprocess.run([HOODOO, "plan", path, "--device", "none"], capture_output=True).returncode == 0]
ok(len(good) > 15 and not bad & set(good), f"it takes the {len(good)} jobs here that hoodoo takes", bad & set(good), done.stdout[:2000])

HEAD = "hoodoo: 1\nname: a\nframes: 1-2\n"
SPACE = "domain: {size_m: [8, 8, 8], spacing_m: 1}\n"
SCENE = "scene: {box: {min_m: [1, 1, 0], max_m: [7, 7, 6]}}\n"
BROKEN = [
    SPACE + SCENE, HEAD + SCENE, HEAD + SPACE, "hoodoo: 2\nname: a\nframes: 1-2\n" + SPACE + SCENE, "hoodoo: 1\nname: 'a b'\nframes: 1-2\n" + SPACE + SCENE,
    "hoodoo: 1\nname: a\nframes: one\n" + SPACE + SCENE, "hoodoo: 1\nname: a\nframes: 1..2\n" + SPACE + SCENE,
    HEAD + "domain: {size_m: [8, 8], spacing_m: 1}\n" + SCENE, HEAD + "domain: {size_m: [8, 8, 8, 8], spacing_m: 1}\n" + SCENE,
    HEAD + "domain: {size_m: [8, 8, 8], spacing_m: 0}\n" + SCENE, HEAD + "domain: {size_m: [8, 8, 8], spacing_m: one}\n" + SCENE,
    HEAD + "domain: {size_m: [8, 8, 8]}\n" + SCENE, HEAD + "domain: {size: [8, 8, 8], spacing_m: 1}\n" + SCENE,
    HEAD + "domain: {size_m: 8, spacing_m: 1}\n" + SCENE, HEAD + SPACE + "scene: {cube: {min_m: [1, 1, 0], max_m: [7, 7, 6]}}\n",
    HEAD + SPACE + "scene: {box: {min_m: [1, 1, 0]}}\n", HEAD + SPACE + "scene: {box: {min_m: [1, 1, 0], max_m: [7, 7, 6], colour: red}}\n",
    HEAD + SPACE + "scene: {box: {min_m: [1, 1, 0], max_m: [7, 7, 6]}, sphere: {center_m: [1, 1, 1], radius_m: 1}}\n",
    HEAD + SPACE + "scene: {union: []}\n", HEAD + SPACE + "scene: {union: {box: {min_m: [1, 1, 0], max_m: [7, 7, 6]}}}\n",
    HEAD + SPACE + "scene: []\n", HEAD + SPACE + "scene: {sphere: {center_m: [1, 1, 1], radius_m: -1}}\n",
] + [HEAD + SPACE + SCENE + extra + "\n" for extra in (
    "wynd: {}", "wind: {speed_m_s: fast}", "wind: {speed_m_s: -1}", "wind: {sped_m_s: 1}", "wind: {speed_m_s: {1001: 8, ease: quick}}",
    "wind: {speed_m_s: {first: 8}}", "wind: {direction: [1, 0]}", "wind: {flow: {solver: fluid}}", "model: arenites", "fps: 0", "fps: '24'", "seed: -1",
    "seed: 1.5", "strata: {weak_m_per_kyr: 1}", "strata: [{weak: 1}]", "strata: [{weak_m_per_kyr: a lot}]", "output: {up: x}", "output: {vdb: {half: 1}}",
    "output: {aov: {cameras: main}}", "output: {aov: {samples: 0}}", "cameras: [main]", "cameras: {main: {resolution: [1, 1]}}", "cameras: {main: {focal: 35}}",
    "checkpoint: {every: 0}", "checkpoint: {mark: [now]}", "edits: {frame: 2}", "rain: {m_per_yr: wet}", "sources: [{path_m: [1, 2, 3]}]", "stress: {solver: magic}")]
paths = []
for i, text in enumerate(BROKEN):
    paths.append(f"broken_{i:02d}.yaml")
    with open(paths[-1], "w") as file:
        file.write(text)
taken = [(path, BROKEN[i]) for i, path in enumerate(paths) if hoodoo("plan", path, "--device", "none")[0] == 0]
ok(not taken, f"hoodoo refuses {len(paths)} broken jobs", *taken)
bad, done = refused(paths)
ok(bad == set(paths), "and so does the schema", *[(p, BROKEN[int(p[7:9])]) for p in sorted(set(paths) - bad)], done.stderr[:500])
finish()

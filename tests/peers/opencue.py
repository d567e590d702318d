"""OpenCue's own library, PyOutline, reads our outline, makes its job specification of it (cjsl), and executes its layers: the job is done. The two wedges
have a GPU request and an odd folder."""

import json
import os
import sys

sys.dont_write_bytecode = True
from script import HOODOO, TOP, ask, finish, ok

VENV = os.path.join(os.path.dirname(HOODOO), "opencue")
READ = """
import json, sys
import xml.etree.ElementTree as tree
import outline, outline.cuerun
from outline.backend import cue
ol = outline.load_outline(sys.argv[1])
launcher = outline.cuerun.OutlineLauncher(ol, show="show", shot="shot", user="me")
launcher.setup() if hasattr(launcher, "setup") else ol.setup()
spec = tree.fromstring(cue.serialize(launcher).split(">", 2)[2])
layers = {l.get("name"): {c.tag: c.text for c in l} | {"env": {k.get("name"): k.text for k in l.find("env")}} for l in spec.iter("layer")}
depends = sorted({(d.find("deplayer").text, d.find("onlayer").text) for d in spec.iter("depend")})
if len(sys.argv) > 2:
    import os
    for layer in ol.get_layers():
        os.environ.update(layer.get_envs())
        for frame in range(1, len(layer.get_arg("commands")) + 1):
            layer.execute(frame)
print("FOUND " + json.dumps({"layers": layers, "depends": depends, "order": [l.get_name() for l in ol.get_layers()]}))
"""


def read(path, *more):
    code, said = ask(os.path.join(VENV, "bin", "python"), "read.py", path, *more, env={**os.environ, "HOME": os.path.abspath("home"), "SHOW": "show", "SHOT": "shot"})
    found = [line for line in said.splitlines() if line.startswith("FOUND ")]
    return code, json.loads(found[-1][6:]) if found else {}, said


if not os.path.exists(os.path.join(VENV, "bin", "pycuerun")):
    code, said = ask("python3", "-m", "venv", VENV)
    code, said = (code, said) if code else ask(os.path.join(VENV, "bin", "pip"), "install", "--quiet", "opencue-pyoutline==1.37.0", "packaging==26.4")
    if code:
        ok(False, "PyOutline can be installed", said)
        sys.exit(1)
os.mkdir("home")
with open("read.py", "w") as file:
    file.write(READ)
with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as file:
    text = file.read().replace("frames: 1001-1012", "frames: 1001-1004")
with open("job.yaml", "w") as file:
    file.write(text + "farm: {block_frames: 2, chunk_frames: 1, meshes: true, still_every: 0, turntable: 0, on_done: [sh, -c, echo $HOODOO_STATE >done], sim: {hours: 2}}\n"
               "wedge: {over: [{key: seed, values: [3, 4]}]}\n")
out = os.path.abspath("it's an \"out\" dir")
code, said = ask(HOODOO, "submit", "job.yaml", "--to", "opencue", "--out", out + ".gpu")
ok(code == 0 and "pycuerun" in said, "an outline is written", said)
code, found, said = read(out + ".gpu/twelve.outline")
if ok(code == 0 and found, "PyOutline reads it and makes a job specification", said[-2500:]):
    sim = found["layers"]["w0001_sim_1001-1002"]
    ok(sim["gpus"] == "1" and sim["gpu_memory"].endswith("m") and sim["memory"].endswith("m") and sim["cores"] == "2.0" and sim["timeout"] == "120" and
       sim["range"] in ("1", "1-1"), "a block requests a GPU, memory, cores and time", sim)
    ok(found["layers"]["w0002_mesh_1003"]["range"] == "1-2" and "gpus" not in found["layers"]["w0002_mesh_1003"], "the meshes of a block are a layer without", found["layers"]["w0002_mesh_1003"])
    ok(["w0002_sim_1003-1004", "w0002_sim_1001-1002"] in found["depends"] and ["w0001_mesh_1001", "w0001_sim_1001-1002"] in found["depends"] and len(found["layers"]) == 9,
       "layers wait for each other as tasks do", found["depends"])
code, said = ask(HOODOO, "submit", "job.yaml", "--to", "opencue", "--device", "cpu", "--out", out)
code, found, said = read(out + "/twelve.outline", "execute")
ok(code == 0 and not any("gpus" in layer for layer in found["layers"].values()), "PyOutline executes the layers of a job for CPUs", said[-2500:])
code, said = ask(HOODOO, "status", out, "--json")
status = json.loads(said)
ok(status["tasks_done"] == status["task_count"] == 13 and open(out + "/done").read() == "done\n", "and the job is done, with its hook", said[-1500:])
finish()

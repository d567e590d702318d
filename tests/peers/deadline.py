"""AWS Deadline Cloud's own library reads our job bundle: its template, parameters and asset references."""

import json
import os
import sys

sys.dont_write_bytecode = True
from script import HOODOO, TOP, ask, finish, ok

VENV = os.path.join(os.path.dirname(HOODOO), "deadline")
READ = """
import json, sys
from deadline.client.job_bundle import loader, parameters
from deadline.client.job_bundle.submission import AssetReferences
from openjd.model import create_job, decode_job_template, preprocess_job_parameters
from pathlib import Path
folder = sys.argv[1]
assert loader.is_job_bundle_dir(folder)
loader.validate_directory_symlink_containment(folder)
found = parameters.read_job_bundle_parameters(folder)
assets = AssetReferences.from_dict(loader.read_yaml_or_json_object(folder, "asset_references", False))
template = decode_job_template(template=loader.read_yaml_or_json_object(folder, "template", True), supported_extensions=["TASK_CHUNKING"])
values = {p["name"]: str(p["value"]) for p in found if "value" in p and ":" not in p["name"]}
job = create_job(job_template=template, job_parameter_values=preprocess_job_parameters(job_template=template, job_parameter_values=values,
    job_template_dir=Path(folder), current_working_dir=Path(folder), allow_job_template_dir_walk_up=True))
print(json.dumps({"values": {p["name"]: p.get("value") for p in found}, "inputs": sorted(assets.input_filenames), "outputs": sorted(assets.output_directories),
                  "steps": [s.name for s in job.steps]}))
"""

if not os.path.exists(os.path.join(VENV, "bin", "deadline")):
    code, said = ask("python3", "-m", "venv", VENV)
    code, said = (code, said) if code else ask(os.path.join(VENV, "bin", "pip"), "install", "--quiet", "deadline==0.60.10", "openjd-model==0.13.0")
    if code:
        ok(False, "deadline can be installed", said)
        sys.exit(1)
with open(os.path.join(TOP, "tests/restart/twelve.yaml")) as f:
    text = f.read()
with open("height.csv", "w") as f:
    f.write("seed\n3\n4\n")
with open("job.yaml", "w") as f:
    f.write(text + "farm: {block_frames: 6, meshes: true, still_every: 5, turntable: 8, retries: 2, on_done: [echo, done]}\nwedge: {csv: height.csv}\n")
out = os.path.abspath("an out dir")
code, said = ask(HOODOO, "submit", "job.yaml", "--to", "deadline", "--device", "cpu", "--out", out)
ok(code == 0, "a bundle is written", said)
with open("read.py", "w") as f:
    f.write(READ)
code, said = ask(os.path.join(VENV, "bin", "python"), "read.py", out + "/twelve.bundle")
if ok(code == 0, "the library reads it, and makes a job of it", said):
    got = json.loads(said.splitlines()[-1])
    ok(got["values"]["JobFile"] == out + "/farm/job.yaml" and got["values"]["OutDir"] == out and got["values"]["deadline:maxRetriesPerTask"] == 2, "its parameters are this folder's", got)
    ok(got["outputs"] == [out] and got["inputs"] == [], "its output folder is named", got)
    ok({"Sim_1001-1006", "Mesh_1007-1012", "Stills", "Views", "Wedges", "End"} <= set(got["steps"]), "it has the steps", got)
finish()

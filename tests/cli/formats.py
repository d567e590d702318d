"""Files that releases have left (tests/formats/VERSION): checkpoints are gone on from, manifests, records, stacks and jobs are read. What a
later release can no longer load it has to refuse in one sentence, which this then asks for."""

import json
import os
import shutil
import sys

sys.dont_write_bytecode = True
from script import *

FORMATS = os.path.join(TOP, "tests/formats")
ANY = ("--resume", "other-device-and-build", "--progress", "none")


def continued(version, model):
    """From the checkpoint of frame 1, in a folder that has lost its frames' files."""
    kept, out = os.path.join(FORMATS, version, model), f"{version}.{model}"
    shutil.copytree(kept, out)
    code, said = hoodoo("inspect", f"{out}/checkpoint/{model}.0001.ckpt", "--json")
    ok(code == 0, f"{version}: {model}'s checkpoint is described", code, said)
    code, said = hoodoo("inspect", f"{out}/frames/{model}.0001.json")
    ok(code == 0, f"{version}: {model}'s manifest is described", code, said)
    code, said = hoodoo("run", f"{out}/{model}.yaml", "--out", out, *ANY)
    verified = hoodoo("verify", out)
    ok(code == 0 and "continuing from the checkpoint of frame 1" in said and verified[0] == 0, f"{version}: {model} goes on from its checkpoint", code, said,
       verified)


for version in sorted(entry.name for entry in os.scandir(FORMATS) if entry.is_dir()):
    for model in ("arenite", "goblins", "arches"):
        continued(version, model)
    resolved = os.path.join(FORMATS, version, "arenite/resolved.yaml")
    code, said = hoodoo("plan", resolved, "--device", "none")
    ok(code == 0, f"{version}: a job with every default is read", code, said)
    with open("stacks.json", "w") as file:
        json.dump({"hoodoo": 1, "name": "stacks", "frames": "1", "domain": {"size_m": [4, 4, 4], "spacing_m": 1},
                   "scene": {"stacks": {"file": os.path.join(FORMATS, version, "arches/stacks/arches.0001.stacks")}}}, file)
    code, said = hoodoo("plan", "stacks.json", "--device", "none")
    ok(code == 0, f"{version}: stacks are read", code, said)
    shutil.copytree(os.path.join(FORMATS, version, "arenite/records"), f"{version}.arenite/records", dirs_exist_ok=True)
    code, said = hoodoo("verify", f"{version}.arenite")
    ok(code in (0, 3) and "own hash" not in said and "later format" not in said, f"{version}: which verify can read", code, said)
finish()

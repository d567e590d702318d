"""Files of earlier releases (tests/formats/VERSION): runs continue from checkpoints, and manifests, records, stacks and jobs can be read. A file
that a later release can no longer load must be refused with a clear message, which this test then expects."""

import json
import os
import shutil
import struct
import sys

sys.dont_write_bytecode = True
from script import *

sys.path.insert(0, os.path.join(TOP, "tests/cli/lib"))
import read_formats

FORMATS = os.path.join(TOP, "tests/formats")
ANY = ("--resume", "other-device-and-build", "--progress", "none")


def read_as_written_down(version, model, out):
    """A reader written from the pages about formats reads the files of this build and of that release."""
    try:
        for number in sorted(int(name.split(".")[-2]) for name in os.listdir(f"{out}/checkpoint") if name.endswith(".ckpt")):
            index, sections = read_formats.checkpoint(f"{out}/checkpoint/{model}.{number:04d}.ckpt")
            frame = read_formats.sealed(f"{out}/frames/{model}.{number:04d}.json")
            seen = json.loads(hoodoo("inspect", f"{out}/checkpoint/{model}.{number:04d}.ckpt", "--json")[1])
            assert index["frame"] == frame["frame"] == number and index["job_hash"] == frame["job_xxh3"] and index["years"] == frame["years"]
            assert [s["name"] for s in seen["sections"]] == list(sections), seen["sections"]
            if model != "arches":
                assert struct.unpack("<5Q", sections["ledger"]) == tuple(frame["ledger"].values())
        if os.path.isdir(f"{out}/records"):
            for folder, _, names in os.walk(f"{out}/records"):
                for name in names:
                    record = read_formats.sealed(os.path.join(folder, name))
                    with open(os.path.join(out, record["path"]), "rb") as file:
                        assert read_formats.hexed(file.read()) == record["xxh3"], record
        problem = ""
    except (AssertionError, KeyError, ValueError, struct.error) as error:
        problem = repr(error)
    ok(not problem, f"{version}: {model}'s files read as src/*/FORMAT.md say", problem)


def continued(version, model):
    """Continues from the checkpoint of frame 1 in a folder without the files of its frames."""
    kept, out = os.path.join(FORMATS, version, model), f"{version}.{model}"
    shutil.copytree(kept, out)
    code, said = hoodoo("inspect", f"{out}/checkpoint/{model}.0001.ckpt", "--json")
    ok(code == 0, f"{version}: {model}'s checkpoint is described", code, said)
    code, said = hoodoo("inspect", f"{out}/frames/{model}.0001.json")
    ok(code == 0, f"{version}: {model}'s manifest is described", code, said)
    code, said = hoodoo("run", f"{out}/{model}.yaml", "--out", out, *ANY)
    verified = hoodoo("verify", out)
    read_as_written_down(version, model, out)
    ok(code == 0 and "continuing from the checkpoint of frame 1" in said and verified[0] == 0, f"{version}: {model} continues from its checkpoint", code, said,
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
    nx, ny, cell, quantum, layers = read_formats.stacks(os.path.join(FORMATS, version, "arches/stacks/arches.0001.stacks"))
    rock = sum(top - (column[i - 1][0] if i else 0) for column in layers for i, (top, material) in enumerate(column) if material == 1) * cell * cell * quantum
    with open(os.path.join(FORMATS, version, "arches/frames/arches.0001.json")) as file:
        ledger = json.load(file)["ledger"]
    ok((nx, ny) == (4, 4) and abs(rock - ledger["rock"] * cell * cell * quantum) < 1e-9, f"{version}: and by their page: {rock:.3f} m3 of bedrock", ledger)
    shutil.copytree(os.path.join(FORMATS, version, "arenite/records"), f"{version}.arenite/records", dirs_exist_ok=True)
    code, said = hoodoo("verify", f"{version}.arenite")
    ok(code in (0, 3) and "own hash" not in said and "later format" not in said, f"{version}: which verify can read", code, said)
finish()

"""alpha.py camera EXR CAMERA.json: the camera an EXR carries. alpha.py compare EXR PNG WHAT: how much two silhouettes have in common."""

import json
import sys

import numpy as np
import OpenImageIO


def alpha(path):
    file = OpenImageIO.ImageInput.open(path)
    spec = file.spec()
    at = spec.channelnames.index("A")
    return file.read_image(0, 0, at, at + 1, OpenImageIO.FLOAT)[:, :, 0] > 0.5


if sys.argv[1] == "camera":
    spec = OpenImageIO.ImageInput.open(sys.argv[2]).spec()
    found = {a.name.lower(): list(a.value) for a in spec.extra_attribs if "world" in a.name.lower()}
    with open(sys.argv[3], "w") as file:
        json.dump({"worldToCamera": found["worldtocamera"],
                   "worldToNDC": found.get("worldtondc") or found["worldtoscreen"], "size": [spec.width, spec.height]}, file)
else:
    ours, theirs = alpha(sys.argv[2]), alpha(sys.argv[3])
    both, any_ = (ours & theirs).sum(), (ours | theirs).sum()
    iou = both / max(any_, 1)
    print(f"# {ours.sum()} pixels of rock here, {theirs.sum()} in Blender, {both} in both: intersection over union {iou:.4f}")
    print("ok" if iou >= 0.97 and 0.05 < ours.mean() < 0.9 else "not ok",
          f"Blender sees the mesh where the picture has the rock ({sys.argv[4]})")

"""in_usd_rocks.py FOLDER y|z: opens the stage of usd_rocks.yaml's run as Pixar's USD does: rocks as a point instancer."""
import json
import os
import subprocess
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdValidation

root, up = sys.argv[1], sys.argv[2]
HOODOO, RADIUS, frames = os.environ["HOODOO"], 0.4, [1, 2, 3, 4]


def check(good, name, *notes):
    print("ok" if good else "not ok", f"{name} (output.up: {up})")
    if not good:
        print("#", *notes)


def mesh_of(prim):
    mesh = UsdGeom.Mesh(prim)
    return np.array(mesh.GetPointsAttr().Get()), np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3), np.array(mesh.GetNormalsAttr().Get())


stage = Usd.Stage.Open(f"{root}/2-piles.usda")
context = UsdValidation.ValidationContext(UsdValidation.ValidationRegistry().GetOrLoadAllValidators())
errors = [e.GetMessage() for e in context.Validate(stage)]
check(not errors, "validators find nothing", *errors)
rocks = UsdGeom.PointInstancer(stage.GetPrimAtPath("/_2_piles/rocks"))
targets = rocks.GetPrototypesRel().GetTargets()
shapes = [stage.GetPrimAtPath(p) for p in targets]
check(0 < len(shapes) <= 20 and all(s.IsA(UsdGeom.Mesh) for s in shapes), "every shape is a mesh", len(shapes))
check(rocks.GetPositionsAttr().GetTimeSamples() == frames, "rocks have a sample for every frame", rocks.GetPositionsAttr().GetTimeSamples())

# ---- shapes
closed = outward = sized = True
for s in shapes:
    at, face, normal = mesh_of(s)
    edges = {}
    for a, b in np.concatenate([face[:, [0, 1]], face[:, [1, 2]], face[:, [2, 0]]]):
        edges[(a, b)] = edges.get((a, b), 0) + 1
    closed &= all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items())
    volume = (np.cross(at[face[:, 0]], at[face[:, 1]]) * at[face[:, 2]]).sum() / 6
    across = np.cross(at[face[:, 1]] - at[face[:, 0]], at[face[:, 2]] - at[face[:, 0]])
    outward &= volume > 0.5 * RADIUS**3 and ((across * normal[face[:, 0]]).sum(1) > 0).mean() > 0.97
    box = np.array(UsdGeom.Mesh(s).GetExtentAttr().Get())
    sized &= np.allclose(box, [at.min(0), at.max(0)], atol=1e-5)
check(closed, "shapes are closed")
check(outward, "and face outward, as their normals do")
check(sized, "their extents are theirs")
color = UsdGeom.PrimvarsAPI(shapes[0]).GetPrimvar("displayColor").Get()[0]
check(np.allclose(color, (0.5, 0.25, 0.125)), "of the job's colour", color)

# ---- rocks, against the points in rocks/*.vdb
ids = {}
for frame in frames:
    at, shape, turn = (np.array(a.Get(frame)) for a in (rocks.GetPositionsAttr(), rocks.GetProtoIndicesAttr(), rocks.GetOrientationsAttr()))
    own = np.array(rocks.GetIdsAttr().Get(frame))
    told = json.loads(subprocess.run([HOODOO, "inspect", "--json", f"{root}/rocks/2-piles.{frame:04d}.vdb"], capture_output=True, check=True).stdout)
    count = sum(g.get("points", 0) for g in told["grids"])
    check(len(at) == len(shape) == len(turn) == len(set(own)) == count, f"as many rocks in {frame} as in its points", len(at), count)
    ids[frame] = dict(zip(own, map(tuple, at)))
    if len(at) == 0:
        continue
    check(shape.min() >= 0 and shape.max() < len(shapes) and all(q.GetReal() == 1 for q in rocks.GetOrientationsAttr().Get(frame)),
          f"shapes there are, not turned ({frame})")
    low, high = np.array(rocks.GetExtentAttr().Get(frame))
    computed = np.array(rocks.ComputeExtentAtTime(frame, frame))
    check(np.allclose([low, high], computed, atol=1e-3), f"extent of {frame}", low, high, computed)
    vertical, size = at[:, 1 if up == "y" else 2], np.abs(at).max(0)
    check((vertical > 0).all() and (vertical < 7).all() and size.max() <= 16, f"rocks of {frame} lie in the terrain", size)
check(len(ids[1]) == 0 and len(ids[4]) > 50, "none at first, then piles", *(len(i) for i in ids.values()))
both = ids[3].keys() & ids[4].keys()
check(len(both) > 10 and all(np.allclose(ids[3][i], ids[4][i]) for i in both), "an id is a place", len(both))
bound = UsdGeom.BBoxCache(4, ["default"]).ComputeWorldBound(rocks.GetPrim()).ComputeAlignedRange()
check(np.allclose([bound.GetMin(), bound.GetMax()], rocks.GetExtentAttr().Get(4), atol=1e-3), "a viewer frames them", bound)

"""in_usd.py FOLDER y|z LAST: opens the stage of usd.yaml's run as Pixar's USD does, and compares it with the other files."""
import glob
import json
import math
import os
import subprocess
import sys

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdValidation, UsdVol, Vt

root, up, last = sys.argv[1], sys.argv[2], int(sys.argv[3])
NAME, HOODOO = "9-arches", os.environ["HOODOO"]
SPACING, LOW, HIGH = 0.5, (2, 2, 0), (14, 6, 10)
frames = list(range(1001, last + 1))


def check(good, name, *notes):
    print("ok" if good else "not ok", f"{name} (output.up: {up}, to {last})")
    if not good:
        print("#", *notes)


def to_file(v):
    return (v[0], v[2], -v[1]) if up == "y" else tuple(v)


stage = Usd.Stage.Open(f"{root}/{NAME}.usda")
prim = stage.GetDefaultPrim()
check(prim and prim.GetPath() == "/_9_arches", "a default prim of a legal name", prim)
check(UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.StageHasAuthoredMetersPerUnit(stage), "metres")
check(UsdGeom.GetStageUpAxis(stage) == up.upper(), "the up axis", UsdGeom.GetStageUpAxis(stage))
check((stage.GetStartTimeCode(), stage.GetEndTimeCode(), stage.GetTimeCodesPerSecond()) == (1001, 1005, 25), "the job's frames and rate")

# What usdchecker runs.
registry = UsdValidation.ValidationRegistry()
context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
errors = [e.GetMessage() for e in context.Validate(stage)]
check(not errors, "validators find nothing", *errors)

# ---- volumes
volume = UsdVol.Volume(stage.GetPrimAtPath("/_9_arches/rock"))
fields = {name: UsdVol.OpenVDBAsset(stage.GetPrimAtPath(path)) for name, path in volume.GetFieldPaths().items()}
described = json.loads(subprocess.run([HOODOO, "inspect", "--json", f"{root}/volumes/{NAME}.{last}.vdb"], capture_output=True, check=True).stdout)
grids = {grid["name"]: grid for grid in described["grids"]}
check(fields.keys() == grids.keys() and {"surface", "density", "stress", "von_mises", "viability"} <= fields.keys(),
      "a field for every grid", *fields, *grids)
kinds = {"level set": "levelSet", "fog volume": "fogVolume", "unknown": "unknown"}
good = all(f.GetFieldNameAttr().Get() == n and f.GetFieldClassAttr().Get() == kinds[grids[n]["class"]] and
           f.GetFieldDataTypeAttr().Get() == {"float": "float", "vec3s": "float3"}[grids[n]["type"]] for n, f in fields.items())
check(good, "of its name, class and type")
good = all(f.GetFilePathAttr().GetTimeSamples() == frames for f in fields.values())
check(good, "with a sample for every frame done")
good = all(os.path.samefile(f.GetFilePathAttr().Get(t).resolvedPath, f"{root}/volumes/{NAME}.{t}.vdb") for f in fields.values() for t in frames)
check(good, "that resolves to the frame's file")
low, high = volume.GetExtentAttr().Get()
check(all(low[a] <= grid["bounds_m"]["min"][a] and grid["bounds_m"]["max"][a] <= high[a] for grid in grids.values() for a in range(3)),
      "the extent holds every grid", low, high)

# ---- points
points = UsdGeom.Points(stage.GetPrimAtPath("/_9_arches/points"))
check(points.GetPointsAttr().GetTimeSamples() == frames, "points have a sample for every frame done", points.GetPointsAttr().GetTimeSamples())
counts = []
for frame in frames:
    at = np.array(points.GetPointsAttr().Get(frame))
    n, ids = np.array(points.GetNormalsAttr().Get(frame)), np.array(points.GetIdsAttr().Get(frame))
    counts.append(len(at))
    corners = np.array([to_file(LOW), to_file(HIGH)])
    inside = (at >= corners.min(0) - SPACING).all() and (at <= corners.max(0) + SPACING).all()
    check(inside and len(at) > 500 and len(set(ids)) == len(ids) == len(n) == len(at), f"points of {frame} are in the rock's box, numbered once", len(at))
    check(np.allclose(np.linalg.norm(n, axis=1), 1, atol=1e-4), f"normals of {frame} are unit")
    extent = np.array(points.GetExtentAttr().Get(frame))
    computed = np.array(UsdGeom.Points.ComputeExtent(points.GetPointsAttr().Get(frame), Vt.FloatArray([SPACING] * len(at))))
    check(np.allclose(extent, computed, atol=1e-4), f"extent of {frame}", extent, computed)
check(points.GetWidthsAttr().Get(1001)[0] == SPACING and points.GetWidthsInterpolation() == "constant", "widths are diameters")
n = np.array(points.GetNormalsAttr().Get(1001))
# The side that faces away from the rock's middle.
at = np.array(points.GetPointsAttr().Get(1001))
middle = np.array(to_file((8, 4, 5)))
check((((at - middle) * n).sum(1) > 0).mean() > 0.95, "normals point outwards")
api = UsdGeom.PrimvarsAPI(points)
vertical = at[:, 1 if up == "y" else 2]
color, layer = np.array(api.GetPrimvar("displayColor").Get(1001)), np.array(api.GetPrimvar("layer").Get(1001))
check((layer == (vertical > 5)).all() and np.allclose(color[layer == 0], (0.9, 0.1, 0.1)) and np.allclose(color[layer == 1], (0.1, 0.1, 0.9)),
      "layers and their colours")
stress, viability = np.array(api.GetPrimvar("stress").Get(last)), np.array(api.GetPrimvar("viability").Get(last))
check(1e3 < stress.max() < 1e7 and 0 < viability.min() < viability.max() <= 1 and len(stress) == counts[-1], "stress and viability", stress.max())
held = np.array(points.GetPointsAttr().Get(1002.5))
check(len(held) == counts[1], "between frames they stay")
bound = UsdGeom.BBoxCache(1001, ["default"]).ComputeWorldBound(points.GetPrim()).ComputeAlignedRange()
check(np.allclose(bound.GetSize(), np.ptp(at, axis=0) + SPACING, atol=1e-3), "a viewer frames them", bound)

# ---- cameras, against the matrices of the pictures
paths = sorted(str(p.GetPath()) for p in stage.Traverse() if p.IsA(UsdGeom.Camera))
check(paths == [f"/_9_arches/cameras/{n}" for n in ("ma_in", "ma_in__2", "main")], "three cameras of three names", *paths)
moving = UsdGeom.Camera(stage.GetPrimAtPath("/_9_arches/cameras/main"))
still = UsdGeom.Camera(stage.GetPrimAtPath("/_9_arches/cameras/ma_in__2"))
check(len(moving.GetOrderedXformOps()[0].GetTimeSamples()) == 5 and not still.GetOrderedXformOps()[0].GetTimeSamples(),
      "a camera that moves has samples, another has none")
for path, picture, size, lens, aperture in (("main", "main", (64, 36), lambda f: 35, 36), ("ma_in", "ma-in", (40, 40), lambda f: 50 - 5.5 * (f - 1001), 24),
                                             ("ma_in__2", "ma_in", (64, 27), lambda f: 28, 36)):
    for frame in frames:
        camera, focal = UsdGeom.Camera(stage.GetPrimAtPath(f"/_9_arches/cameras/{path}")).GetCamera(frame), lens(frame)
        told = json.loads(subprocess.run([HOODOO, "inspect", "--json", f"{root}/aov/{NAME}.{picture}.{frame}.exr"], capture_output=True,
                                         check=True).stdout)
        exr = np.array(told["parts"][0]["attributes"]["worldToCamera"]).reshape(4, 4)
        # EXR looks along +z, left-handed; USD along -z.
        ours = np.array(camera.frustum.ComputeViewMatrix()) @ np.diag([1, 1, -1, 1])
        check(np.allclose(exr, ours, atol=1e-5), f"{picture} stands where the worldToCamera of {frame} says", exr, ours)
        wanted = math.degrees(2 * math.atan(aperture / 2 / focal))
        check(math.isclose(camera.GetFieldOfView(Gf.Camera.FOVHorizontal), wanted, rel_tol=1e-5), f"{picture} sees as wide in {frame}", wanted)
        check(math.isclose(camera.aspectRatio, size[0] / size[1], rel_tol=1e-5), f"{picture} has the picture's shape")
        # GfCamera counts in tenths of the unit: decimetres here.
        check(math.isclose(camera.focalLength * Gf.Camera.FOCAL_LENGTH_UNIT * 1000, focal, rel_tol=1e-5), f"{picture}: {focal} mm", camera.focalLength)

# ---- light: the sun shines from where it stands, and it and the sky are lights to USD
from pxr import UsdLux  # noqa: E402
sun, sky = UsdLux.DistantLight(stage.GetPrimAtPath("/_9_arches/lights/sun")), UsdLux.DomeLight(stage.GetPrimAtPath("/_9_arches/lights/sky"))
shines = np.array(UsdGeom.Xformable(sun.GetPrim()).ComputeLocalToWorldTransform(last).TransformDir(Gf.Vec3d(0, 0, -1)))
azimuth, elevation = math.radians(25 + 2 * (last - 1001)), math.radians(35)
wanted = to_file((-math.cos(elevation) * math.cos(azimuth), -math.cos(elevation) * math.sin(azimuth), -math.sin(elevation)))
check(bool(sun) and bool(sky) and np.allclose(shines, wanted, atol=1e-5), "the sun shines from where light.sun says", shines, wanted)
check(0.5 < sun.GetIntensityAttr().Get(last) < 10 and sky.GetColorAttr().Get(last)[2] > sky.GetColorAttr().Get(last)[0] and sun.GetColorAttr().Get(last)[0] > 1,
      "warm, and the sky blue", sun.GetIntensityAttr().Get(last))
points = UsdGeom.Xformable(sun.GetPrim()).GetOrderedXformOps()[0].GetTimeSamples()
check(len(points) == 5, "a sun that moves has samples", points)

# ---- on their own
own = Usd.Stage.Open(f"{root}/points/{NAME}.1001.usdc")
check(UsdGeom.GetStageUpAxis(own) == up.upper() and UsdGeom.Points(own.GetDefaultPrim()), "a frame's points open by themselves")
listed = [f["path"] for frame in frames for f in json.load(open(f"{root}/frames/{NAME}.{frame}.json"))["files"]]
check(all(f"points/{NAME}.{t}.usdc" in listed for t in frames) and not any(p.endswith(".usda") for p in listed),
      "manifests list the points, and not the stage")

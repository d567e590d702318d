"""in_usd_mesh.py FOLDER y|z: the meshes of usd.yaml's run, as Pixar's USD has them in the stage, against the PLYs."""
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdShade, UsdValidation

root, up = sys.argv[1:]
NAME = "9-arches"


def check(good, name, *notes):
    print("ok" if good else "not ok", f"{name} (meshes, output.up: {up})")
    if not good:
        print("#", *notes)


def ply(path):
    """Vertices by name, and faces."""
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    kinds = {"float": "<f4", "int": "<i4", "uchar": "u1"}
    lines = [line.split() for line in head.decode().split("\n")]
    count = {line[1]: int(line[2]) for line in lines if line and line[0] == "element"}
    vertex = np.dtype([(line[2], kinds[line[1]]) for line in lines if line and line[0] == "property" and line[1] != "list"])
    n = count["vertex"] * vertex.itemsize
    face = np.frombuffer(body[n:], np.dtype([("n", "u1"), ("v", "<i4", 3)]), count["face"])
    return np.frombuffer(body[:n], vertex), face["v"]


stage = Usd.Stage.Open(f"{root}/{NAME}.usda")
registry = UsdValidation.ValidationRegistry()
errors = [e.GetMessage() for e in UsdValidation.ValidationContext(registry.GetOrLoadAllValidators()).Validate(stage)]
check(not errors, "validators find nothing", *errors)
mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/_9_arches/surface"))
frames = mesh.GetPointsAttr().GetTimeSamples()
check(frames == list(range(1001, 1006)), "a sample for every frame", frames)
check(mesh.GetSubdivisionSchemeAttr().Get() == "none" and mesh.GetOrientationAttr().Get() == "rightHanded", "triangles, wound to the right")
api = UsdGeom.PrimvarsAPI(mesh)
for frame in (1001, 1003, 1005):
    vertex, face = ply(f"{root}/mesh/{NAME}.{frame}.ply")
    at = np.array(mesh.GetPointsAttr().Get(frame))
    corner = np.array(mesh.GetFaceVertexIndicesAttr().Get(frame)).reshape(-1, 3)
    check(np.array_equal(at, np.stack([vertex[a] for a in "xyz"], 1)) and np.array_equal(corner, face), f"{frame}: the PLY's triangles", len(at), len(vertex))
    check(set(mesh.GetFaceVertexCountsAttr().Get(frame)) == {3} and UsdGeom.Mesh.ValidateTopology(mesh.GetFaceVertexIndicesAttr().Get(frame),
          mesh.GetFaceVertexCountsAttr().Get(frame), len(at))[0], f"{frame}: sound topology")
    n = np.array(mesh.GetNormalsAttr().Get(frame))
    across = np.cross(at[corner[:, 1]] - at[corner[:, 0]], at[corner[:, 2]] - at[corner[:, 0]])
    check(np.allclose(np.linalg.norm(n, axis=1), 1, atol=1e-3) and ((across * n[corner[:, 0]]).sum(1) > 0).mean() > 0.98, f"{frame}: normals out of the rock")
    extent = np.array(mesh.GetExtentAttr().Get(frame))
    check(np.allclose(extent, [at.min(0), at.max(0)], atol=1e-5), f"{frame}: a tight extent", extent)
    same = all(np.array_equal(np.array(api.GetPrimvar(v).Get(frame)), vertex[v]) for v in ("stress", "von_mises", "viability", "layer"))
    color = np.array(api.GetPrimvar("displayColor").Get(frame))
    check(same and len(color) == len(at) and color.min() >= 0 and color.max() <= 1, f"{frame}: values and colours of every vertex")
check(not mesh.GetVelocitiesAttr().HasAuthoredValue(), "rock that stands has no velocities")
material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
surface = material.ComputeSurfaceSource()[0] if material else None
check(surface and surface.GetIdAttr().Get() == "UsdPreviewSurface" and surface.GetInput("diffuseColor").HasConnectedSource(), "a material of the strata's colours")
check(UsdGeom.Imageable(stage.GetPrimAtPath("/_9_arches/points")).ComputePurpose() == "proxy" and
      UsdGeom.Imageable(stage.GetPrimAtPath("/_9_arches/rock")).ComputeVisibility() == "invisible", "meshes are rendered; volumes and points stand by")

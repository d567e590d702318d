"""in_trimesh.py PATH: PATH.ply and PATH.obj of twelve.yaml, read by plyfile and trimesh."""
import sys

import numpy as np
import plyfile
import trimesh

PATH = sys.argv[1]
COLORS = {(192, 151, 118), (173, 119, 89)}


def check(name, good, *notes):
    print("ok" if good else "not ok", name)
    if not good:
        print("#", *notes)


ply = plyfile.PlyData.read(PATH + ".ply")
vertex = ply["vertex"]
names = [p.name for p in vertex.properties]
check("plyfile: every property", names == ["x", "y", "z", "nx", "ny", "nz", "stress", "von_mises", "viability", "discharge", "vegetation",
                                           "deposit", "layer", "red", "green", "blue"], names)
check("plyfile: of its type", vertex["layer"].dtype == np.int32 and vertex["red"].dtype == np.uint8 and vertex["stress"].dtype == np.float32)
check("plyfile: layers and colours", set(np.unique(vertex["layer"])) == {0, 1} and
      {tuple(int(vertex[c][i]) for c in ("red", "green", "blue")) for i in range(vertex.count)} == COLORS)
volume = {}
for extension in ("ply", "obj"):
    mesh = trimesh.load(f"{PATH}.{extension}", process=False)
    volume[extension] = mesh.volume
    check(f"trimesh: {extension}: watertight, wound one way, a volume", mesh.is_watertight and mesh.is_winding_consistent and mesh.is_volume)
    colors = {tuple(int(x) for x in c[:3]) for c in mesh.visual.vertex_colors}
    check(f"trimesh: {extension}: colours", all(min(np.abs(np.subtract(c, d)).max() for d in COLORS) <= 1 for c in colors) and len(colors) == 2, colors)
check("trimesh: both are one", abs(volume["ply"] / volume["obj"] - 1) < 1e-6, volume)

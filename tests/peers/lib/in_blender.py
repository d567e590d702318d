"""blender ... --python in_blender.py -- FILE y|z: imports the volumes of twelve.yaml's first frame as a user does, and looks."""

import math
import sys

import bpy
from mathutils import Vector

path, up = sys.argv[sys.argv.index("--") + 1:]
VOXEL = 0.5
LOW, HIGH = (2, 2, 0), (14, 6, 10)  # the rock of twelve.yaml, in the simulator's axes (z up, as in Blender)
GRIDS = {"surface", "density", "stress", "von_mises", "viability"}


def check(name, good, *notes):
    print("ok" if good else "not ok", f"{name} (output.up: {up})")
    if not good:
        print("#", *notes)


def bounds(points):
    points = list(points)
    return [tuple(pick(p[i] for p in points) for i in range(3)) for pick in (min, max)]


def near(box, slack):
    """Within `slack` voxels, outwards and inwards."""
    return all(abs(a - b) <= slack * VOXEL for side, wanted in zip(box, (LOW, HIGH)) for a, b in zip(side, wanted))


for other in list(bpy.data.objects):
    bpy.data.objects.remove(other)
bpy.ops.object.volume_import(filepath=path, files=[{"name": path.rsplit("/", 1)[1]}], directory=path.rsplit("/", 1)[0],
                             use_sequence_detection=False)
volume = bpy.context.object
check("one volume comes in", volume is not None and volume.type == "VOLUME", volume)
grids = volume.data.grids
check("it loads", grids.load() and grids.error_message == "", grids.error_message)
names = {grid.name: grid.data_type for grid in grids}
check("the grids have their names", GRIDS <= names.keys(), names)
check("they are scalars", all(names[name] == "FLOAT" for name in GRIDS & names.keys()), names)
turn = math.pi / 2 if up == "y" else 0
check("Blender turns it upright by itself", math.isclose(volume.rotation_euler[0], turn, abs_tol=1e-6), volume.rotation_euler)
bpy.context.view_layer.update()
box = bounds(volume.matrix_world @ Vector(corner) for corner in volume.bound_box)
check("its box holds the rock, in whole leaves of 8 voxels", near(box, 3 + 8) and all(
    low <= a and b <= high for low, a, b, high in zip(box[0], LOW, HIGH, box[1])), box)

# Blender's Volume to Mesh adds half a voxel in the volume's own axes, to match how it draws volumes.
shift = volume.matrix_world.to_3x3() @ Vector((VOXEL / 2,) * 3)
for name, threshold in (("density", 0.5), ("surface", 0)):
    mesh = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    bpy.context.collection.objects.link(mesh)
    mesh.matrix_world = volume.matrix_world
    modifier = mesh.modifiers.new("surface", "VOLUME_TO_MESH")
    modifier.object = volume
    modifier.grid_name = name
    modifier.threshold = threshold
    bpy.context.view_layer.update()
    evaluated = mesh.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    check(f"{name} becomes a mesh", len(evaluated.vertices) > 100, len(evaluated.vertices))
    box = bounds(mesh.matrix_world @ vertex.co - shift for vertex in evaluated.vertices) if evaluated.vertices else None
    print("#", name, box)
    check("its rock stands where the simulator has it, the same way up", box is not None and near(box, 1), box)

"""blender ... --python mesh_in_blender.py -- PATH: imports PATH.ply and PATH.obj of twelve.yaml as a user does, and looks."""
import sys

import bpy

path = sys.argv[sys.argv.index("--") + 1]
LINEAR = [(0.53, 0.31, 0.18), (0.42, 0.185, 0.10)]  # the layers' colours


def check(name, good, *notes):
    print("ok" if good else "not ok", name)
    if not good:
        print("#", *notes)


for extension, read in (("ply", bpy.ops.import_mesh.ply), ("obj", bpy.ops.wm.obj_import)):
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    read(filepath=f"{path}.{extension}")
    thing = bpy.context.selected_objects[0]
    mesh = thing.data
    check(f"blender: {extension}: nothing to mend", not mesh.validate(verbose=True) and len(mesh.polygons) > 1000)
    # Blender's own attribute values are linear.
    colors = {tuple(round(x, 2) for x in c.color[:3]) for c in mesh.color_attributes[0].data}
    good = all(min(max(abs(x - y) for x, y in zip(c, d)) for d in LINEAR) < 0.02 for c in colors)
    check(f"blender: {extension}: linear colours", good and len(colors) >= 2, colors)
    low = min((thing.matrix_world @ v.co).z for v in mesh.vertices)
    high = max((thing.matrix_world @ v.co).z for v in mesh.vertices)
    # PLY says nothing of axes and comes in as it is, y up; OBJ is taken for y up.
    check(f"blender: {extension}: stands as that format does there", (abs(low) < 0.1 and high > 9) == (extension == "obj"), low, high)

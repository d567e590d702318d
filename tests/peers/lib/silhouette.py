"""blender ... --python silhouette.py -- FOLDER NAME FRAME CAMERA.json OUT.png: the frame's mesh beside its volumes, as a user loads
them, seen by the camera an EXR carries; one sample in each pixel's middle, nothing behind the rock."""

import json
import sys

import bpy
from mathutils import Matrix, Vector

folder, name, frame, camera_file, out = sys.argv[sys.argv.index("--") + 1:]
with open(camera_file) as file:
    said = json.load(file)

for other in list(bpy.data.objects):
    bpy.data.objects.remove(other)
bpy.ops.object.volume_import(filepath=f"{folder}/volumes/{name}.{frame}.vdb", files=[{"name": f"{name}.{frame}.vdb"}],
                             directory=f"{folder}/volumes", use_sequence_detection=False)
volume = bpy.context.object
bpy.context.view_layer.update()
to_blender = volume.matrix_world.copy()  # upright, whatever the files' axes
volume.hide_render = True
bpy.ops.import_mesh.ply(filepath=f"{folder}/mesh/{name}.{frame}.ply")
mesh = bpy.context.object
mesh.matrix_world = to_blender
print("#", len(mesh.data.vertices), "vertices,", len(mesh.data.polygons), "triangles")

# EXR's matrices are for row vectors: a column is an axis of the camera (x right, y up, z ahead), in the files' axes.
m = said["worldToCamera"]
right, up, ahead = (Vector([m[4 * row + axis] for row in range(3)]) for axis in range(3))
move = Vector(m[12:15])
eye = -(right * move[0] + up * move[1] + ahead * move[2])
pose = Matrix([[right[i], up[i], -ahead[i], eye[i]] for i in range(3)] + [[0, 0, 0, 1]])
ndc = said["worldToNDC"]
wide = abs(Vector([ndc[4 * row] for row in range(3)]).dot(right))  # focal length over the film's width
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
bpy.context.collection.objects.link(camera)
camera.data.sensor_fit = "HORIZONTAL"
camera.data.sensor_width = 36
camera.data.lens = 36 * wide
camera.data.clip_end = 1e5
camera.matrix_world = to_blender @ pose

scene = bpy.context.scene
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 1
scene.cycles.use_denoising = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 0.01
scene.cycles.max_bounces = 0
scene.render.film_transparent = True
scene.render.resolution_x, scene.render.resolution_y = said["size"]
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_mode = "RGBA"
scene.render.filepath = out
bpy.ops.render.render(write_still=True)

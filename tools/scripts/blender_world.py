# SPDX-License-Identifier: Apache-2.0
"""Renders a world of one environment texture, and prints its orientation for --probe-rotation.
Runs inside Blender: blender --background --factory-startup --python blender_world.py -- SETTINGS
"""
import json
import math
import sys

import bpy
import mathutils
import numpy

# The importer of Blender 3.4 uses names that NumPy 1.24 removed.
for alias, kind in {"bool": bool, "int": int, "float": float, "object": object}.items():
    if alias not in numpy.__dict__:
        setattr(numpy, alias, kind)


def probe_rotation(mapping=None):
    """The quaternion x,y,z,w of a world whose texture has this Mapping node (Point), or none."""
    blender_to_gltf = mathutils.Matrix(((1, 0, 0), (0, 0, 1), (0, -1, 0)))
    # The node rotates the directions that are looked up, and so the world the other way; without
    # it the centre of the map is seen along +X.
    turn = mathutils.Matrix.Identity(3)
    if mapping:
        turn = mapping.inputs["Rotation"].default_value.to_matrix().inverted()
    turn = blender_to_gltf @ turn @ blender_to_gltf.inverted()
    q = (turn @ mathutils.Matrix.Rotation(-math.pi / 2, 3, "Y")).to_quaternion()
    return f"{q.x:.7f},{q.y:.7f},{q.z:.7f},{q.w:.7f}"


def main():
    settings = json.loads(sys.argv[sys.argv.index("--") + 1])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.import_scene.gltf(filepath=settings["model"])
    scene, render = bpy.context.scene, bpy.context.scene.render
    scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    scene.camera.data.sensor_fit = "VERTICAL"
    scene.camera.data.angle_y = 1.2

    world = bpy.data.worlds.new("probe")
    scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(settings["probe"])
    texture.image.colorspace_settings.name = "Non-Color"
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])
    mapping = None
    if any(settings["rotation"]):
        mapping = nodes.new("ShaderNodeMapping")
        mapping.vector_type = "POINT"
        mapping.inputs["Rotation"].default_value = [math.radians(a) for a in settings["rotation"]]
        links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
        links.new(mapping.outputs["Vector"], texture.inputs["Vector"])

    render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 16
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    render.resolution_x, render.resolution_y = (int(n) for n in settings["size"].split("x"))
    render.resolution_percentage = 100
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.filepath = settings["output"]
    bpy.ops.render.render(write_still=True)
    print("rotation", probe_rotation(mapping))


main()

# SPDX-License-Identifier: Apache-2.0
"""Renders one image with Cycles. Runs inside Blender 3.4:
blender --background --factory-startup --python cycles_render.py -- SETTINGS

SETTINGS is cycles.Settings as JSON. The probe is a lat-long map whose centre looks along glTF's -Z.
Materials of make_demo's models become what the file states: Lambertian, a conductor, smooth glass
of index 1.5, or a plastic, whose diffuse lobe is Disney's in Cycles. Others stay as imported.
"""
import json
import math
import struct
import sys

import bpy
import mathutils
import numpy

# The importer of Blender 3.4 uses names that NumPy 1.24 removed.
for alias, kind in {"bool": bool, "int": int, "float": float, "object": object}.items():
    if alias not in numpy.__dict__:
        setattr(numpy, alias, kind)

settings = json.loads(sys.argv[sys.argv.index("--") + 1])


def gltf_json(path):
    with open(path, "rb") as file:
        file.seek(12)
        (length,) = struct.unpack("<I4x", file.read(8))
        return json.loads(file.read(length))


def import_model():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.import_scene.gltf(filepath=settings["model"])


def place_camera():
    if settings["camera"]:
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        bpy.context.collection.objects.link(camera)
        position, target = (mathutils.Vector((x, -z, y))  # from glTF's axes to Blender's
                            for x, y, z in (settings["camera"]["position"],
                                            settings["camera"]["look_at"]))
        camera.location = position
        camera.rotation_mode = "QUATERNION"
        camera.rotation_quaternion = (target - position).to_track_quat("-Z", "Y")
        angle = math.radians(settings["camera"]["fov"])
    else:
        camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
        angle = gltf_json(settings["model"])["cameras"][0]["perspective"]["yfov"]
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle_y = angle
    bpy.context.scene.camera = camera


def replace_materials():
    """Principled's diffuse lobe is not Lambert's; its metal is GGX with a Fresnel term."""
    for material in bpy.data.materials:
        nodes, links = material.node_tree.nodes, material.node_tree.links
        principled = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
        if principled.inputs["Metallic"].default_value > 0:
            principled.distribution = "MULTI_GGX"
            continue
        glows = max(principled.inputs["Emission"].default_value[:3]) > 0
        smooth = principled.inputs["Roughness"].default_value < 0.9  # glass is, too
        glass = principled.inputs["Transmission"].default_value > 0
        if glows or smooth and not glass:
            continue
        surface = next(node for node in nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"]
        if glass:
            bsdf = nodes.new("ShaderNodeBsdfGlass")
            bsdf.distribution = "SHARP"
            bsdf.inputs["IOR"].default_value = 1.5
            bsdf.inputs["Color"].default_value = (1, 1, 1, 1)
            links.new(bsdf.outputs["BSDF"], surface)
            continue
        diffuse = nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = principled.inputs["Base Color"].default_value
        diffuse.inputs["Roughness"].default_value = 0
        links.new(diffuse.outputs["BSDF"], surface)


def light_with_probe():
    world = bpy.data.worlds.new("probe")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(settings["probe"])
    texture.image.colorspace_settings.name = "Non-Color"  # linear
    # The centre of Blender's map looks along +X; glTF's -Z is Blender's +Y.
    turn = nodes.new("ShaderNodeMapping")
    turn.vector_type = "POINT"
    turn.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])
    nodes["Background"].inputs["Strength"].default_value = settings["scale"]


def configure():
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    cycles.device = "CPU"
    render.threads_mode, render.threads = "FIXED", settings["threads"]
    render.resolution_x, render.resolution_y = settings["size"]
    render.resolution_percentage = 100
    render.film_transparent = False
    cycles.samples, cycles.seed = settings["samples"], settings["seed"]
    cycles.time_limit = settings["seconds"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    bounces = settings["depth"] - 1  # Cycles counts bounces after the first event
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.transmission_bounces = bounces
    cycles.sample_clamp_direct = 0
    cycles.sample_clamp_indirect = 10 if settings["defaults"] else 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 1 if settings["defaults"] else 0
    cycles.use_auto_tile = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"
    render.filepath = settings["output"]


import_model()
place_camera()
if settings["plain_materials"]:
    replace_materials()
light_with_probe()
configure()
bpy.ops.render.render(write_still=True)

# SPDX-License-Identifier: Apache-2.0
"""Renders one image with Cycles. Runs inside Blender 3.4:
blender --background --factory-startup --python cycles_render.py -- MODEL.glb PROBE.exr OUT.exr
        WIDTHxHEIGHT SAMPLES SEED THREADS DEPTH unbiased|defaults

The probe is a lat-long map whose centre looks along glTF's -Z. DEPTH counts scattering events, 1
for direct light. Materials become what the glTF file states: Lambertian, a conductor, smooth glass
of index 1.5, or a plastic, whose diffuse lobe is Disney's in Cycles.
"""
import json
import math
import struct
import sys

import bpy
import numpy

# The importer of Blender 3.4 uses names that NumPy 1.24 removed.
for alias, kind in {"bool": bool, "int": int, "float": float, "object": object}.items():
    if alias not in numpy.__dict__:
        setattr(numpy, alias, kind)

model, probe, output, size, samples, seed, threads, depth, bias = sys.argv[
    sys.argv.index("--") + 1:]
width, height = (int(number) for number in size.split("x"))


def gltf_json(path):
    with open(path, "rb") as file:
        file.seek(12)
        (length,) = struct.unpack("<I4x", file.read(8))
        return json.loads(file.read(length))


def import_model():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.import_scene.gltf(filepath=model)
    camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle_y = gltf_json(model)["cameras"][0]["perspective"]["yfov"]
    bpy.context.scene.camera = camera


def replace_materials():
    """Principled's diffuse lobe is not Lambert's; its metal is GGX with a Fresnel term."""
    for material in bpy.data.materials:
        nodes, links = material.node_tree.nodes, material.node_tree.links
        principled = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
        if principled.inputs["Metallic"].default_value > 0:
            principled.distribution = "MULTI_GGX"
            continue
        if principled.inputs["Roughness"].default_value < 0.9:  # plastics
            continue
        surface = next(node for node in nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"]
        if principled.inputs["Transmission"].default_value > 0:
            glass = nodes.new("ShaderNodeBsdfGlass")
            glass.distribution = "SHARP"
            glass.inputs["IOR"].default_value = 1.5
            glass.inputs["Color"].default_value = (1, 1, 1, 1)
            links.new(glass.outputs["BSDF"], surface)
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
    texture.image = bpy.data.images.load(probe)
    texture.image.colorspace_settings.name = "Non-Color"  # linear
    # The centre of Blender's map looks along +X; glTF's -Z is Blender's +Y.
    turn = nodes.new("ShaderNodeMapping")
    turn.vector_type = "POINT"
    turn.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])


def configure():
    scene = bpy.context.scene
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    cycles.device = "CPU"
    render.threads_mode, render.threads = "FIXED", int(threads)
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.film_transparent = False
    cycles.samples, cycles.seed = int(samples), int(seed)
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    bounces = int(depth) - 1  # Cycles counts bounces after the first event
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.transmission_bounces = bounces
    cycles.sample_clamp_direct = 0
    cycles.sample_clamp_indirect = 10 if bias == "defaults" else 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 1 if bias == "defaults" else 0
    cycles.use_auto_tile = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"
    render.filepath = output


import_model()
replace_materials()
light_with_probe()
configure()
bpy.ops.render.render(write_still=True)

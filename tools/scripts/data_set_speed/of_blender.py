# SPDX-License-Identifier: Apache-2.0
"""Renders the views with Blender's Cycles as a module, denoised by Open Image Denoise."""
import math
import os
import sys

import bpy
import mathutils
from views import measure


def vector(position):
    x, y, z = position
    return mathutils.Vector((x, -z, y))  # from glTF's axes to Blender's


def light_with(probe):
    world = bpy.data.worlds.new("probe")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(probe)
    texture.image.colorspace_settings.name = "Linear Rec.709"
    # The centre of Blender's map looks along +X; glTF's -Z is Blender's +Y.
    turn = nodes.new("ShaderNodeMapping")
    turn.inputs["Rotation"].default_value = (0, 0, -math.pi / 2)
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])


def configure(s):
    scene = bpy.context.scene
    render, cycles, layer = scene.render, scene.cycles, bpy.context.view_layer
    render.engine, cycles.device = "CYCLES", "CPU"
    render.use_persistent_data = True
    render.threads_mode, render.threads = ("FIXED", s.threads) if s.threads else ("AUTO", 0)
    render.resolution_x = render.resolution_y = s.size
    cycles.samples, cycles.use_adaptive_sampling = s.samples, False
    cycles.use_denoising, cycles.denoiser = True, "OPENIMAGEDENOISE"
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = s.depth - 1
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_diffuse_color = True
    layer.use_pass_object_index = layer.use_pass_material_index = True
    scene.view_settings.view_transform = "Standard"
    render.image_settings.media_type = "MULTI_LAYER_IMAGE"
    render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "NONE"


class Scene:
    def __init__(self, settings):
        self.settings = s = settings
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_scene.gltf(filepath=s.model)
        for i, item in enumerate(bpy.data.objects):
            item.pass_index = i + 1
        for i, material in enumerate(bpy.data.materials):
            material.pass_index = i + 1
        light_with(s.probe)
        configure(s)
        self.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        bpy.context.collection.objects.link(self.camera)
        bpy.context.scene.camera = self.camera
        self.camera.data.sensor_fit = "VERTICAL"
        self.camera.data.angle_y = math.radians(s.fov)
        self.camera.rotation_mode = "QUATERNION"

    def render(self, i, position):
        """Passes are only to be had as a file: in memory, where there is such a folder."""
        s, scene = self.settings, bpy.context.scene
        self.camera.location = vector(position)
        self.camera.rotation_quaternion = (vector(s.target) - vector(position)).to_track_quat("-Z", "Y")
        scene.cycles.seed = i
        scene.render.filepath = s.scratch + "/view.exr"
        bpy.ops.render.render(write_still=True)
        assert os.path.getsize(scene.render.filepath) > 4 * 8 * s.size * s.size
        if i == 0:
            scene.render.image_settings.media_type = "IMAGE"
            scene.render.image_settings.file_format = "PNG"
            bpy.data.images["Render Result"].save_render(s.picture)
            configure(s)


# Blender reports on the standard output, which is for the result.
out, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
os.dup2(null, 1)
sys.stdout = os.fdopen(out, "w")
measure(Scene, Scene.render)

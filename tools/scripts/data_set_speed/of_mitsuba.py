# SPDX-License-Identifier: Apache-2.0
"""Renders the views with Mitsuba 3, whose denoiser needs OptiX: without denoising."""
import json
import struct

import mitsuba as mi
import numpy as np
from views import measure

mi.set_variant("llvm_ad_rgb")
T = mi.ScalarTransform4f
AOVS = "depth:depth,normal:sh_normal,albedo:albedo,shape:shape_index,primitive:prim_index"


class Glb:
    """Triangles and metallic-roughness materials of a binary glTF file without animation."""

    def __init__(self, path, scratch):
        self.scratch = scratch
        data = open(path, "rb").read()
        (length,) = struct.unpack_from("<I", data, 12)
        self.root, self.bytes = json.loads(data[20:20 + length]), data[28 + length:]

    def accessor(self, index):
        a = self.root["accessors"][index]
        view = self.root["bufferViews"][a["bufferView"]]
        kind = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[a["type"]]
        begin = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        stride = view.get("byteStride", width * np.dtype(kind).itemsize)
        return np.ndarray((a["count"], width), kind, self.bytes, begin, (stride, np.dtype(kind).itemsize))

    def image(self, texture, raw):
        view = self.root["bufferViews"][self.root["images"][self.root["textures"][texture]["source"]]["bufferView"]]
        begin = view.get("byteOffset", 0)
        path = self.scratch + "/image"
        with open(path, "wb") as file:
            file.write(self.bytes[begin:begin + view["byteLength"]])
        bitmap = mi.Bitmap(path)
        return bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False) if raw else bitmap

    def texture(self, texture, channel=None):
        if channel is None:
            return {"type": "bitmap", "bitmap": self.image(texture["index"], False)}
        plane = np.ascontiguousarray(np.array(self.image(texture["index"], True))[..., channel:channel + 1])
        return {"type": "bitmap", "bitmap": mi.Bitmap(plane), "raw": True}

    def material(self, index):
        m = self.root["materials"][index]
        surface, extensions = m.get("pbrMetallicRoughness", {}), m.get("extensions", {})
        rough = surface.get("metallicRoughnessTexture")
        base = surface.get("baseColorTexture")
        color = surface.get("baseColorFactor", [1, 1, 1, 1])[:3]
        bsdf = {"type": "principled",
                "base_color": self.texture(base) if base else {"type": "rgb", "value": color},
                "roughness": self.texture(rough, 1) if rough else surface.get("roughnessFactor", 1.0),
                "metallic": self.texture(rough, 2) if rough else surface.get("metallicFactor", 1.0),
                "specular": 0.5 * extensions.get("KHR_materials_specular", {}).get("specularFactor", 1.0)}
        if "normalTexture" in m:
            normals = np.array(self.image(m["normalTexture"]["index"], True))
            normals[..., 1] = 1 - normals[..., 1]  # glTF's v points down, and its bitangent up
            texture = {"type": "bitmap", "bitmap": mi.Bitmap(normals), "raw": True}
            bsdf = {"type": "normalmap", "normalmap": texture, "bsdf": bsdf}
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        glow = [strength * x for x in m.get("emissiveFactor", [0, 0, 0])]
        return {"type": "twosided", "bsdf": bsdf}, glow, m.get("emissiveTexture")

    def shapes(self):
        nodes = self.root["nodes"]
        pending = [(i, np.eye(4)) for i in self.root["scenes"][self.root.get("scene", 0)]["nodes"]]
        while pending:
            index, parent = pending.pop()
            node = nodes[index]
            to_world = parent @ matrix(node)
            pending += [(child, to_world) for child in node.get("children", [])]
            for primitive in self.root["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
                yield self.shape(primitive, to_world)

    def shape(self, primitive, to_world):
        attributes = primitive["attributes"]
        positions, normals = self.accessor(attributes["POSITION"]), self.accessor(attributes["NORMAL"])
        faces = self.accessor(primitive["indices"]).reshape(-1, 3)
        bsdf, glow, map_of_glow = self.material(primitive["material"])
        properties = mi.Properties()
        properties["bsdf"] = mi.load_dict(bsdf)
        if any(glow):
            radiance = self.texture(map_of_glow) if map_of_glow else {"type": "rgb", "value": glow}
            properties["emitter"] = mi.load_dict({"type": "area", "radiance": radiance})
        mesh = mi.Mesh("mesh", len(positions), len(faces), properties, True, "TEXCOORD_0" in attributes)
        parameters = mi.traverse(mesh)
        linear = to_world[:3, :3]
        turned = normals @ np.linalg.inv(linear)
        parameters["vertex_positions"] = np.ravel(positions @ linear.T + to_world[:3, 3]).astype(np.float32)
        parameters["vertex_normals"] = np.ravel(turned / np.linalg.norm(turned, axis=1, keepdims=True)).astype(np.float32)
        if "TEXCOORD_0" in attributes:
            parameters["vertex_texcoords"] = np.ravel(self.accessor(attributes["TEXCOORD_0"])).astype(np.float32)
        parameters["faces"] = np.ravel(faces).astype(np.uint32)
        parameters.update()
        return mesh


def matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    m = np.eye(4)
    m[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]))
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


class Scene:
    def __init__(self, settings):
        self.settings = s = settings
        dictionary = {"type": "scene",
                      "integrator": {"type": "aov", "aovs": AOVS,
                                     "path": {"type": "path", "max_depth": s.depth + 1, "rr_depth": 5}},
                      "probe": {"type": "envmap", "filename": s.probe, "to_world": T().rotate([0, 1, 0], 180),
                                "mis_compensation": True}}
        for i, shape in enumerate(Glb(s.model, s.scratch).shapes()):
            dictionary[f"shape{i}"] = shape
        self.scene = mi.load_dict(dictionary)
        self.sampler = {"type": "multijitter", "sample_count": s.samples}
        self.film = {"type": "hdrfilm", "width": s.size, "height": s.size, "rfilter": {"type": "box"},
                     "pixel_format": "rgba"}

    def render(self, i, position):
        s = self.settings
        sensor = mi.load_dict({"type": "perspective", "fov": s.fov, "fov_axis": "y", "film": self.film,
                               "sampler": self.sampler,
                               "to_world": T().look_at(origin=position, target=s.target, up=[0, 1, 0])})
        image = mi.render(self.scene, sensor=sensor, seed=i, spp=s.samples)
        array = np.array(image)
        assert array.shape[:2] == (s.size, s.size)
        if i == 0:
            mi.util.write_bitmap(s.picture, image[..., :3])


measure(Scene, Scene.render)

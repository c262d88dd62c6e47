# SPDX-License-Identifier: Apache-2.0
"""Writes models of boxes, spheres, tori and quadrilaterals as glTF."""
import base64
import json
import math
import struct


class Model:
    def __init__(self):
        self.data = bytearray()
        self.root = {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_specular"], "scene": 0,
                     "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [],
                     "bufferViews": []}

    def _accessor(self, rows, form, kind, bounds=False):
        values = [value for row in rows for value in row]
        component = {"f": 5126, "I": 5125}[form]
        accessor = {"bufferView": len(self.root["bufferViews"]), "componentType": component,
                    "count": len(values) if kind == "SCALAR" else len(rows), "type": kind}
        if bounds:
            accessor |= {"min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]}
        packed = struct.pack(f"<{len(values)}{form}", *values)
        self.root["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed
        self.root["accessors"].append(accessor)
        return len(self.root["accessors"]) - 1

    def material(self, color, roughness=1.0, metallic=0.0, texture=None):
        """Without metal and with roughness 1 it is Lambertian. `texture`: a file beside the model."""
        surface = {"baseColorFactor": [*color, 1], "roughnessFactor": roughness, "metallicFactor": metallic}
        if texture:
            names = [image["uri"] for image in self.root.setdefault("images", [])]
            if texture not in names:
                self.root["images"].append({"uri": texture})
                self.root.setdefault("textures", []).append({"source": len(names)})
                names.append(texture)
            surface["baseColorTexture"] = {"index": names.index(texture)}
        material = {"pbrMetallicRoughness": surface}
        if not metallic and roughness == 1:
            material["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}}
        self.root["materials"].append(material)
        return len(self.root["materials"]) - 1

    def mesh(self, name, material, points, normals, texels, triangles):
        primitive = {"attributes": {"POSITION": self._accessor(points, "f", "VEC3", True),
                                    "NORMAL": self._accessor(normals, "f", "VEC3"),
                                    "TEXCOORD_0": self._accessor(texels, "f", "VEC2")},
                     "indices": self._accessor(triangles, "I", "SCALAR"), "material": material}
        self.root["meshes"].append({"primitives": [primitive]})
        self.root["scenes"][0]["nodes"].append(len(self.root["nodes"]))
        self.root["nodes"].append({"name": name, "mesh": len(self.root["meshes"]) - 1})

    def quads(self, name, material, quads):
        """Each of a corner and two edges; a x b is the side that it shows."""
        points, normals, texels, triangles = [], [], [], []
        for corner, a, b in quads:
            normal = cross(a, b)
            length = math.hypot(*normal)
            first = len(points)
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                points.append(tuple(corner[i] + u * a[i] + v * b[i] for i in range(3)))
                normals.append(tuple(c / length for c in normal))
                texels.append((u, 1 - v))
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        self.mesh(name, material, points, normals, texels, triangles)

    def box(self, name, material, low, high, turn=0):
        """Along the axes, turned by `turn` degrees about the vertical axis through its middle."""
        dx, dy, dz = (high[i] - low[i] for i in range(3))
        x, y, z = low
        quads = [((x, y, z + dz), (dx, 0, 0), (0, dy, 0)), ((x + dx, y, z), (-dx, 0, 0), (0, dy, 0)),
                 ((x, y, z), (0, 0, dz), (0, dy, 0)), ((x + dx, y, z + dz), (0, 0, -dz), (0, dy, 0)),
                 ((x, y + dy, z + dz), (dx, 0, 0), (0, 0, -dz)), ((x, y, z), (dx, 0, 0), (0, 0, dz))]
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        mx, mz = x + dx / 2, z + dz / 2

        def turned(p, ox, oz):
            return (ox + c * (p[0] - ox) + s * (p[2] - oz), p[1], oz - s * (p[0] - ox) + c * (p[2] - oz))

        self.quads(name, material, [(turned(p, mx, mz), turned(a, 0, 0), turned(b, 0, 0)) for p, a, b in quads])

    def surface(self, name, material, at, columns, rows):
        """`at(u, v)` -> point, normal, for u and v of 0 to 1."""
        grid = [at(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
        texels = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
        triangles = []
        for j in range(rows):
            for i in range(columns):
                a = j * (columns + 1) + i
                b = a + columns + 1
                triangles += [(a, b, a + 1), (a + 1, b, b + 1)]
        self.mesh(name, material, [p for p, _ in grid], [n for _, n in grid], texels, triangles)

    def sphere(self, name, material, centre, radius, columns=256, rows=128):
        def at(u, v):
            polar, turn = math.pi * v, 2 * math.pi * u
            n = (math.sin(polar) * math.sin(turn), math.cos(polar), math.sin(polar) * math.cos(turn))
            return tuple(centre[i] + radius * n[i] for i in range(3)), n

        self.surface(name, material, at, columns, rows)

    def torus(self, name, material, centre, radius, tube):
        """Lies on its side: its axis is vertical."""
        def at(u, v):
            turn, around = 2 * math.pi * u, -2 * math.pi * v
            n = (math.cos(around) * math.sin(turn), math.sin(around), math.cos(around) * math.cos(turn))
            ring = (radius * math.sin(turn), 0, radius * math.cos(turn))
            return tuple(centre[i] + ring[i] + tube * n[i] for i in range(3)), n

        self.surface(name, material, at, 96, 48)

    def write(self, path):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        self.root["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        path.write_text(json.dumps(self.root))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

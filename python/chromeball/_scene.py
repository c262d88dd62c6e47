# SPDX-License-Identifier: Apache-2.0
"""Scenes from models, arrays and lamps."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _arrays, _values
from ._core import Geometry, MaterialBsdf, Session, check_scene
from ._errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_TEXTURES = ("base_color_texture", "metallic_roughness_texture", "normal_texture", "emission_texture")


class Material:
    """A metallic-roughness material of glTF 2.0 with its extensions. Colours are linear Rec. 709, 0 to 1.

    base_color: three numbers, or four with alpha; one for grey. metallic (0 by default, unlike in glTF), roughness
    (1 by default; GGX alpha is its square), emission (radiance), ior, specular, specular_color, alpha_mode ("opaque",
    "mask", "blend"), alpha_cutoff, double_sided (else the camera does not see backs), unlit.

    transmission (0 to 1) with thin_walled (True by default: a sheet; False: the mesh bounds a body and refracts),
    attenuation (of the body, 1/m), dispersion (20 / Abbe number); clearcoat, clearcoat_roughness; sheen_color,
    sheen_roughness; anisotropy, anisotropy_rotation (radians); iridescence, film_ior, film_thickness (nanometres).

    base_color_texture, emission_texture, metallic_roughness_texture (G roughness, B metallic), normal_texture: arrays
    [H,W,3] or [H,W,4], bytes or floats; bytes of colours are encoded in sRGB. Meshes need `uvs` then.
    """

    def __init__(self, **keywords: Any) -> None:
        for name in _TEXTURES:
            if keywords.get(name) is not None:
                keywords[name] = _arrays.texels(f"Material(): {name}", keywords[name])
        self._keywords = _values.copied({"metallic": 0.0, **keywords})
        Geometry().add_material(self._keywords)  # checks it
        self._made: MaterialBsdf | None = None

    def eval(self, wi: Any, wo: Any) -> NDArray[np.float32]:
        """[N,3] f |cos| for light from `wi` [N,3] that leaves to the viewer in `wo` [N,3]; 0 for perfect mirrors and smooth glass.

        Directions point away from the surface, whose front has the normal +z and the tangent +x, in air. f is without
        emission and alpha; textures are refused.
        """
        return self._bsdf().evaluate(*_directions(wi=wi, wo=wo))[0]

    def pdf(self, wi: Any, wo: Any) -> NDArray[np.float32]:
        """[N] the pdf, over solid angle, with which sample() finds `wi` [N,3] for `wo` [N,3]."""
        return self._bsdf().evaluate(*_directions(wi=wi, wo=wo))[1]

    def sample(self, wo: Any, u: Any) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        """Directions `wi` [N,3], weights f |cos| / pdf [N,3], and pdf [N] for `wo` [N,3], from numbers `u` [N,3] in [0, 1); the
        third chooses the lobe. The pdf of the only direction of a mirror is 0; where light is absorbed, the weight is."""
        numbers = _arrays.array("u", u, ("N", 3), "float64")
        if not ((numbers >= 0) & (numbers < 1)).all():
            raise InputError("u: should be 0 or above, and below 1")
        numbers = numbers.clip(0, 1 - 2**-24).astype("float32")  # below 1 after rounding
        (units,) = _directions(wo=wo)
        if len(units) != len(numbers):
            raise InputError(f"u: has the shape {list(numbers.shape)}; it should be [{len(units)},3]")
        return self._bsdf().sample(units, numbers)

    def _bsdf(self) -> MaterialBsdf:
        if self._made is None:
            self._made = MaterialBsdf(self._keywords)
        return self._made

    def __repr__(self) -> str:
        return "Material(" + ", ".join(f"{k}={v!r}" for k, v in self._keywords.items() if k not in _TEXTURES) + ")"


def _directions(**named: Any) -> list[NDArray[Any]]:
    all = [_arrays.directions(name, value) for name, value in named.items()]
    if len({len(vectors) for vectors in all}) > 1:
        raise InputError(f"{' and '.join(named)}: have {' and '.join(str(len(v)) for v in all)} directions")
    return all


class Scene:
    """Models, meshes and lamps. A scene keeps what its last render has loaded and built, for the next one.

    `keys`: other sections of a scene file, such as surroundings={...}.
    """

    def __init__(self, **keys: Any) -> None:
        check_scene(keys, "Scene()")
        lists = {name: _listed(keys.get(name)) for name in ("model", "light")}
        self._keys: dict[str, Any] = _values.copied({**keys, **lists})
        self._geometry = Geometry()
        self._materials: dict[int, tuple[Material, int]] = {}  # by id(), with what keeps that its own
        self._meshes: list[int] = []  # the material of each
        self._idle: list[Session] = []  # of the last render

    def add_model(self, path: str | os.PathLike[str], **keys: Any) -> None:
        """Adds a model (.gltf, .glb), read when the scene is rendered.

        `keys`: of a scene file's [[model]], such as translation, rotation (degrees, or a quaternion), scale, variant,
        animation, time.
        """
        self._add("model", {"file": os.fspath(path), **keys}, "add_model()")

    def add_light(self, type: str, **keys: Any) -> None:
        """Adds a lamp by the keys of a scene file's [[light]].

        type: "sun" (direction, irradiance or radiance, angle), "point" (position, intensity in W/sr or power in W),
        "spot" (also direction, inner_angle, outer_angle), "disc" (position, direction, radius, radiance or power), or
        "list" (file).
        """
        self._add("light", {"type": type, **keys}, "add_light()")

    def add_mesh(
        self,
        positions: Any,
        triangles: Any = None,
        *,
        normals: Any = None,
        uvs: Any = None,
        colors: Any = None,
        material: Material | None = None,
        transform: Any = None,
        name: str = "mesh",
    ) -> int:
        """Adds a mesh of positions [V,3] in metres and triangles [T,3] of vertex numbers, counter-clockwise from the front;
        without triangles, positions are taken in threes.

        normals [V,3]: None is flat. uvs [V,2]: v down. colors [V,3] or [V,4]: linear, from 0 to 1, or as uint8 or uint16, times the base
        colour. transform [4,4]: of column vectors. Returns the mesh's number, for add_instance(). Arrays are copied.
        """
        name = _values.text("name", name)
        points = _arrays.array("positions", positions, ("V", 3), "float32")
        faces = None if triangles is None else _arrays.array("triangles", triangles, ("T", 3), "uint32")
        if len(points) == 0 or (faces is not None and len(faces) == 0):
            raise InputError("add_mesh(): the mesh has no triangles")
        optional: dict[str, Any] = {"normals": None, "uvs": None, "colors": None}
        if normals is not None:
            optional["normals"] = _arrays.finite("normals", normals, ("V", 3))
        if uvs is not None:
            optional["uvs"] = _arrays.array("uvs", uvs, ("V", 2), "float32")
        if colors is not None:
            optional["colors"] = _arrays.colors("colors", colors)
        to_world = None if transform is None else _arrays.matrix("transform", transform)
        number = self._material(material)
        mesh = self._geometry.add_mesh(points, faces, material=number, **optional)
        self._meshes.append(number)
        self._geometry.add_instance(mesh, number, to_world, name)
        return mesh

    def add_instance(self, mesh: int, transform: Any, *, material: Material | None = None, name: str = "mesh") -> None:
        """Shows a mesh, which add_mesh() was given, once more: with a transform [4,4] and perhaps another material."""
        mesh = _values.whole("mesh", mesh, 0, 2**31 - 1)
        if mesh >= len(self._meshes):
            raise InputError(f"add_instance(): there is no mesh {mesh} among {len(self._meshes)}")
        number = self._meshes[mesh] if material is None else self._material(material)
        to_world = _arrays.matrix("transform", transform)
        self._geometry.add_instance(mesh, number, to_world, _values.text("name", name))

    def _material(self, material: Material | None) -> int:
        material = material or _DEFAULT
        if not isinstance(material, Material):
            raise InputError(f"material: is a {type(material).__name__}; it should be a chromeball.Material")
        if id(material) not in self._materials:
            self._materials[id(material)] = (material, self._geometry.add_material(material._keywords))
        return self._materials[id(material)][1]

    def _add(self, section: str, entry: dict[str, Any], caller: str) -> None:
        check_scene({section: [entry]}, caller)
        self._keys[section] = [*self._keys[section], _values.copied(entry)]


def _listed(value: Any) -> list[Any]:
    """One model or light is a list of one."""
    if value is None:
        return []
    return [value] if isinstance(value, str | os.PathLike | dict) else list(value)


def load(path: str | os.PathLike[str], **keys: Any) -> Scene:
    """A scene of one model (.gltf, .glb), with keys as of Scene.add_model()."""
    scene = Scene()
    scene.add_model(path, **keys)
    return scene


_DEFAULT = Material()

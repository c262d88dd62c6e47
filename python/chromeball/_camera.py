# SPDX-License-Identifier: Apache-2.0
"""Cameras."""

from __future__ import annotations

import math
from typing import Any, Sequence

from . import _arrays, _values
from ._core import check_camera
from ._errors import InputError


class Camera:
    """A camera, by the keys of a scene file's section [camera]; looks along -Z of its frame, +Y up.

    Camera(position=(0, 1, 4), look_at=(0, 0.5, 0), fov=40) stands anywhere; Camera(name="Front") is one of the
    model's. `fov` is the vertical field of view in degrees. All kinds take `aperture` (diameter of the lens, metres)
    and `focus` (distance, metres).
    """

    def __init__(self, *, size: tuple[int, int] | None = None, **keys: Any) -> None:
        check_camera(keys, "Camera()")
        self.keys = _values.copied(keys)
        #: Width and height in pixels that renders have where they are not told another; None: any.
        self.size = size

    @staticmethod
    def look_at(
        position: Sequence[float],
        target: Sequence[float],
        up: Sequence[float] = (0, 1, 0),
        **keys: Any,
    ) -> Camera:
        """A camera at `position` that has `target` in the middle of its image (metres, world space)."""
        return Camera(position=position, look_at=target, up=up, **keys)

    @staticmethod
    def from_matrix(camera_to_world: Any, convention: str = "opengl", **keys: Any) -> Camera:
        """A camera with this pose [4,4] or [3,4], from its own coordinates to the world's.

        `convention`: "opengl" (glTF, Blender, NeRF: looks along -Z, +Y up) or "opencv" (COLMAP: along +Z, +Y down).
        """
        import numpy as np

        pose = _arrays.matrix("camera_to_world", camera_to_world)
        if convention not in ("opengl", "opencv"):
            raise InputError(f'convention: `{convention}` is unknown; "opengl" or "opencv"')
        axes = pose[:3, :3] * ([1, -1, -1] if convention == "opencv" else [1, 1, 1])
        if not np.allclose(axes.T @ axes, np.eye(3), atol=1e-4) or np.linalg.det(axes) < 0:
            raise InputError("camera_to_world: its axes should be a rotation: of length 1, at right angles, right-handed")
        position = pose[:3, 3]
        # So far away that rounding to floats does not turn the camera.
        distance = max(1.0, float(np.linalg.norm(position)))
        target = position - distance * axes[:, 2]
        return Camera(position=position.tolist(), look_at=target.tolist(), up=axes[:, 1].tolist(), **keys)

    @staticmethod
    def from_intrinsics(
        K: Any,
        size: tuple[int, int],
        camera_to_world: Any = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
        convention: str = "opengl",
        **keys: Any,
    ) -> Camera:
        """A camera with the matrix K = [[f, 0, cx], [0, f, cy], [0, 0, 1]] [3,3], in pixels of an image of `size`.

        (0, 0) is the top left corner of the image: the middle of a 640 x 480 image is 320, 240. Add 0.5 to cx and cy of
        OpenCV, which has the middle of the first pixel there. `distortion` = (k1, k2) are OpenCV's radial coefficients.
        """
        k = _arrays.array("K", K, (3, 3), "float64")
        if not all(math.isfinite(x) for x in k.flat):
            raise InputError("K: all of it should be finite")
        width, height = (_values.whole("size", n, 1, 2**17) for n in size)
        fx, fy, cx, cy = (float(x) for x in (k[0, 0], k[1, 1], k[0, 2], k[1, 2]))
        if k[1, 0] != 0 or (k[2] != (0, 0, 1)).any():
            raise InputError(f"K: {k.tolist()} should be [[f, 0, cx], [0, f, cy], [0, 0, 1]]")
        if fx <= 0 or fy <= 0:
            raise InputError("K: its focal lengths should be above 0")
        if "fov" in keys:
            raise InputError("fov: K has it")
        if abs(fx - fy) > 1e-3 * fy or abs(float(k[0, 1])) > 1e-3:
            raise InputError(f"K: focal lengths {fx:g} and {fy:g}, skew {float(k[0, 1]):g}: pixels should be square")
        keys = {"principal_point": (cx / width, cy / height), **keys}
        fov = 2 * math.degrees(math.atan2(height / 2, fy))
        return Camera.from_matrix(camera_to_world, convention, fov=fov, size=(width, height), **keys)

    def __repr__(self) -> str:
        return "Camera(" + ", ".join(f"{key}={value!r}" for key, value in self.keys.items()) + ")"

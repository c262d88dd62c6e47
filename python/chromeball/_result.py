# SPDX-License-Identifier: Apache-2.0
"""Rendered images."""

from __future__ import annotations

import json
import os
import warnings
from typing import TYPE_CHECKING, Any

from . import _values
from ._core import Image
from ._errors import RenderWarning

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Result:
    """An image with its layers. Arrays are read-only views of the render's own memory, which they keep alive."""

    def __init__(self, image: Image) -> None:
        self._image = image

    @property
    def color(self) -> NDArray[np.float32]:
        """[H,W,3] radiance, linear Rec. 709; [H,W,4] with alpha, which it is multiplied by, for transparent images."""
        return self._image.color

    @property
    def layers(self) -> dict[str, NDArray[np.float32]]:
        """The layers that were asked for by name, [H,W] or [H,W,C] (docs/output.md)."""
        return self._image.layers

    @property
    def samples(self) -> float:
        """Samples per pixel, the mean."""
        return self._image.samples

    @property
    def noise(self) -> float:
        """The noise of the colour before denoising, as a fraction (docs/output.md); NaN if unknown."""
        return self._image.noise

    @property
    def is_complete(self) -> bool:
        """False if the render goes on, or was cancelled."""
        return self._image.is_complete

    @property
    def stats(self) -> dict[str, Any]:
        """Times, rays, noise, memory and settings, as `chromeball render --stats` writes them; {} of a snapshot."""
        text = self._image.statistics
        return json.loads(text) if text else {}

    @property
    def metadata(self) -> dict[str, Any]:
        """The attributes of an .exr."""
        return self._image.metadata

    @property
    def messages(self) -> list[tuple[str, str]]:
        """Notes and warnings: pairs of "note" or "warning", and the text."""
        return self._image.messages

    def save(self, path: str | os.PathLike[str], **display: Any) -> None:
        """Writes an .exr (all layers), .hdr, .pfm, or a .png by exposure= (stops, or "auto"), tonemap= and
        white_balance=, which replace the render's."""
        for kind, text in self._image.save(_values.path("save()", path), display):
            if kind == "warning":
                warnings.warn(text, RenderWarning, stacklevel=2)

    def png(self, **display: Any) -> bytes:
        """The bytes of a .png, as save() writes it."""
        return self._image.png(display)

    def _repr_png_(self) -> bytes:
        return self.png()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        import numpy as np

        color = self.color
        if (dtype is not None and np.dtype(dtype) != color.dtype) or copy:
            return color.astype(dtype or color.dtype)
        return color

    def __dlpack__(self, *, max_version: tuple[int, int] | None = None, copy: bool | None = None, **keywords: Any) -> Any:
        """The colour, for torch.from_dlpack() and others. Consumers that know of read-only arrays (DLPack 1) share its
        memory; others get a copy."""
        color = self.color
        if copy or max_version is None or max_version[0] < 1:
            return color.copy().__dlpack__(**keywords)
        return color.__dlpack__(max_version=max_version, copy=copy, **keywords)

    def __dlpack_device__(self) -> tuple[int, int]:
        return (1, 0)  # memory of the CPU

    def __repr__(self) -> str:
        height, width = self.color.shape[:2]
        return f"<chromeball.Result {width} x {height}, {self.samples:.4g} samples, noise {100 * self.noise:.2g}%>"


def result_of(image: Image, stacklevel: int) -> Result:
    """The result, whose warnings are Python's."""
    for kind, text in image.messages:
        if kind == "warning":
            warnings.warn(text, RenderWarning, stacklevel=stacklevel + 1)
    return Result(image)

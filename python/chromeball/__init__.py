# SPDX-License-Identifier: Apache-2.0
"""Image-based lighting: renders scenes, lit by HDR light probes, into arrays.

    import chromeball as cb
    scene = cb.load("model.glb")
    image = cb.render(scene, cb.Probe("sky.hdr"), samples=64, denoise=True)
    image.save("picture.png")

Axes: +Y is up; lengths are metres; colours are linear Rec. 709; a probe's middle shows -Z. docs/python.md
describes the module, docs/scene-file.md every keyword.
"""

import atexit as _atexit

from . import _core
from ._camera import Camera
from ._chi_square import ChiSquare, chi_square
from ._compare import Comparison, ComparisonRow, compare
from ._core import version as __version__
from ._errors import InputError, RenderWarning, RunError
from ._probe import Lights, Probe
from ._render import Session, keywords, render
from ._result import Result
from ._scene import Material, Scene, load
from ._strategy import Points, Strategy

__all__ = ["Camera", "ChiSquare", "Comparison", "ComparisonRow", "InputError", "Lights", "Material", "Points", "Probe",
           "RenderWarning", "Result", "RunError", "Scene", "Session", "Strategy", "__version__", "chi_square", "compare",
           "keywords", "load", "render"]

_atexit.register(_core.cancel_all)

# SPDX-License-Identifier: Apache-2.0
"""Renders, at once and in the background."""

from __future__ import annotations

import os
import sys
from typing import Any, Callable, Union

from . import _core, _values
from ._camera import Camera
from ._core import Plan
from ._errors import InputError
from ._probe import Probe
from ._result import Result, result_of
from ._scene import Scene
from ._strategy import CheckedStrategy

SceneLike = Union[Scene, str, "os.PathLike[str]", dict[str, Any]]
ProbeLike = Union[Probe, str, "os.PathLike[str]", None]
#: Called with the name of a stage and the fraction of it that is done, NaN if unknown.
Progress = Union[bool, Callable[[str, float], object], None]


def keywords(name: str | None = None) -> Any:
    """The names of all keywords of render(), or what one of them means, with its valid values."""
    return _core.keywords() if name is None else _core.help_of(_values.text("keywords()", name))


def _plan(caller: str, scene: SceneLike, probe: ProbeLike, camera: Camera | None, settings: dict[str, Any],
          is_compared: bool = False) -> Plan:
    settings = {key: value for key, value in settings.items() if value is not None}
    if probe is not None and not isinstance(probe, Probe):
        if not isinstance(probe, (str, os.PathLike)):
            raise InputError(f"{caller}: probe is a {type(probe).__name__}; it should be a chromeball.Probe, or a file")
        settings["probe"] = probe
        probe = None
    if camera is not None and not isinstance(camera, Camera):
        raise InputError(f"{caller}: camera is a {type(camera).__name__}; it should be a chromeball.Camera")
    if camera is not None and camera.size is not None:
        settings.setdefault("size", camera.size)
    if "crop" in settings and not isinstance(settings["crop"], str):
        settings["crop"] = _crop(caller, settings["crop"])
    strategy = None
    if not isinstance(settings.get("strategy", ""), str):
        strategy = CheckedStrategy(settings.pop("strategy"))
    geometry = None
    source: Any
    if isinstance(scene, Scene):
        source, geometry = scene._keys, scene._geometry
    elif isinstance(scene, dict):
        source = scene
    elif isinstance(scene, (str, os.PathLike)):
        source = os.fspath(scene)
    else:
        raise InputError(f"{caller}: scene is a {type(scene).__name__}; it should be a chromeball.Scene, a file or a dict")
    return _core.plan(source, geometry, None if probe is None else probe._map,
                      None if camera is None else camera.keys, settings, strategy, is_compared, caller)


def _crop(caller: str, window: Any) -> str:
    numbers = list(window) if hasattr(window, "__len__") else []
    if len(numbers) != 4:
        raise InputError(f"{caller}: crop: {window!r} should be (x, y, width, height) in pixels")
    return ",".join(str(_values.whole(f"{caller}: crop", number, 0, 2**31 - 1)) for number in numbers)


def _bar(stage: str, fraction: float) -> None:
    done = "" if fraction != fraction else f" {100 * fraction:3.0f}%"
    end = "\n" if stage == "render" and fraction == 1 else ""
    sys.stderr.write(f"\r{stage}{done}\x1b[K{end}")
    sys.stderr.flush()


def _callback(progress: Progress) -> Callable[[str, float], object] | None:
    if progress is None or progress is False:
        return None
    if progress is True:
        return _bar
    if not callable(progress):
        raise InputError(f"progress: is a {type(progress).__name__}; it should be True, or be called with (stage, fraction)")
    return progress


def render(
    scene: SceneLike,
    probe: ProbeLike = None,
    camera: Camera | None = None,
    *,
    progress: Progress = None,
    **settings: Any,
) -> Result:
    """Renders an image.

    scene: a Scene; a scene file (.toml) or model (.gltf, .glb) by its path; or a dict with the keys of a scene file.
    probe: its file, which takes the place of the scene's, as by the command's --probe; or a Probe, which the scene's rotation
    (or probe_rotation=) turns further and its scale scales further; None: the scene's own light. camera: None is the
    scene's, or one that frames it. progress: True shows a bar; or it is called with (stage, fraction), from another thread.

    Settings have the names of `chromeball render`'s options with underscores (keywords(); docs/scene-file.md): size=(width,
    height), samples=, time= (seconds), noise= (percent), strategy= (a name, or an object with sample() and pdf():
    docs/python.md), denoise=, layers=[...], seed=, probe_rotation=, transparent=, max_depth=, quality=, threads= and others.

    The same scene and settings give the same bits as the command. Other threads of Python go on meanwhile; Ctrl-C ends the
    render. Throws InputError, RunError; what may spoil the image is a RenderWarning.
    """
    callback = _callback(progress)
    plan = _plan("render()", scene, probe, camera, settings)
    idle = scene._idle if isinstance(scene, Scene) else []
    try:
        session = idle.pop()
        session.update(plan)
        session.progress = callback
    except IndexError:
        session = _core.Session(plan, callback)
    session.start()
    image = session.wait()
    session.progress = None
    if not idle:
        idle.append(session)
    return result_of(image, stacklevel=2)


class Session:
    """A render in the background. Arguments as of render().

        with cb.Session(scene, probe, camera, samples=4096) as session:
            preview = session.snapshot()
            image = session.wait()

    After update(), what did not change is neither loaded nor built again.
    """

    def __init__(
        self,
        scene: SceneLike,
        probe: ProbeLike = None,
        camera: Camera | None = None,
        *,
        progress: Progress = None,
        **settings: Any,
    ) -> None:
        self._arguments: dict[str, Any] = {"scene": scene, "probe": probe, "camera": camera}
        self._settings = settings
        self._session = _core.Session(_plan("Session()", scene, probe, camera, settings), _callback(progress))

    def start(self) -> Session:
        """Begins, if it has not begun."""
        self._session.start()
        return self

    def wait(self) -> Result:
        """The image when it is finished; after cancel(), the one so far. Throws the errors of the render. Ctrl-C cancels
        it and is passed on."""
        return result_of(self._session.wait(), stacklevel=2)

    def snapshot(self) -> Result | None:
        """The image so far, not denoised, without stopping the render; None before the first samples."""
        image = self._session.snapshot()
        return None if image is None else Result(image)

    def update(self, **changes: Any) -> Session:
        """Ends the render, and changes arguments (scene=, probe=, camera=) and settings for the next start(). None takes a
        setting back."""
        arguments = {**self._arguments, **{k: v for k, v in changes.items() if k in self._arguments}}
        settings = {**self._settings, **{k: v for k, v in changes.items() if k not in self._arguments}}
        self._session.update(_plan("update()", settings=settings, **arguments))
        self._arguments, self._settings = arguments, settings
        return self

    def cancel(self) -> None:
        """Ends the render, and waits for its end."""
        self._session.cancel()

    @property
    def is_running(self) -> bool:
        return self._session.is_running

    @property
    def fraction(self) -> float:
        """Of the render's work that is done; NaN if unknown."""
        return self._session.fraction

    @property
    def work(self) -> dict[str, Any]:
        """What the last start() has loaded and built."""
        return self._session.work

    def __enter__(self) -> Session:
        return self.start()

    def __exit__(self, *_: object) -> None:
        self.cancel()

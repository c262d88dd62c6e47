# SPDX-License-Identifier: Apache-2.0
"""A small scene of arrays, and the command of the same build."""

import os
import pathlib
import sys

import numpy as np
import pytest

import chromeball as cb

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SQUARE = np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], np.float32)
TWO = np.array([[0, 1, 2], [0, 2, 3]])


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def command():
    """The path of `chromeball`, which is linked with the same library."""
    path = pathlib.Path(os.environ.get("CHROMEBALL_COMMAND", pathlib.Path(cb.__file__).parents[2] / "chromeball"))
    if not path.exists():
        pytest.skip("the command is not built")
    return path


def sky(height=16):
    """A smooth probe [H,W,3], brighter above and to the right."""
    y, x = np.mgrid[0:height, 0 : 2 * height]
    return np.stack([0.2 + x / x.max(), 0.5 + 0 * x, 1.2 - y / y.max()], axis=-1).astype(np.float32)


def square_scene(**keywords):
    scene = cb.Scene()
    scene.add_mesh(SQUARE, TWO, material=cb.Material(base_color=(0.5, 0.4, 0.3), specular=0, **keywords))
    return scene


@pytest.fixture
def scene():
    return square_scene()


@pytest.fixture
def camera():
    return cb.Camera.look_at((0, 2, 2), (0, 0, 0), fov=40)


@pytest.fixture
def small():
    return {"size": (24, 16), "samples": 16, "threads": 2}

# SPDX-License-Identifier: Apache-2.0
"""The examples: programs, data sets, the notebook."""

import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import PROJECT
from test_session import ENVIRONMENT

EXAMPLES = PROJECT / "python" / "examples"


def run(example, *arguments):
    done = subprocess.run([sys.executable, EXAMPLES / example, "--quick", *arguments], env=ENVIRONMENT,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("example", sorted(path.name for path in EXAMPLES.glob("*.py")))
def test_programs(example, tmp_path):
    if example == "dataset_ray.py":
        pytest.importorskip("ray")
    assert run(example) and any(tmp_path.iterdir())


def manifest(folder):
    """The lines, in the order of the images."""
    lines = [json.loads(line) for path in folder.glob("manifest*.jsonl") for line in path.read_text().splitlines()]
    return sorted(lines, key=lambda line: line["image"])


def same_arrays(a, b):
    first, second = np.load(a), np.load(b)
    return set(first) == set(second) and all(np.array_equal(first[name], second[name], equal_nan=True) for name in first)


def test_images_of_a_data_set_do_not_depend_on_who_renders_them(tmp_path):
    assert "4 of 4 images" in run("dataset.py", "--folder", "whole")
    assert "2 of 4 images" in run("dataset.py", "--folder", "parts", "--shard", "2/2", "--threads", "1")
    assert "2 of 4 images" in run("dataset.py", "--folder", "parts", "--shard", "1/2")
    whole, parts = manifest(tmp_path / "whole"), manifest(tmp_path / "parts")
    assert whole == parts and [line["image"] for line in whole] == [0, 1, 2, 3]
    for line in whole:
        png, exr, npz = line["files"]
        assert same_arrays(tmp_path / "whole" / npz, tmp_path / "parts" / npz)
        assert (tmp_path / "whole" / png).read_bytes() == (tmp_path / "parts" / png).read_bytes()
        assert (tmp_path / "whole" / exr).exists()
    run("dataset.py", "--folder", "other", "--seed", "1", "--shard", "1/4")
    (other,) = manifest(tmp_path / "other")
    assert other["camera_to_world"] != whole[0]["camera_to_world"] and other["rotation"] != whole[0]["rotation"]


def test_a_data_set_goes_on_where_it_was_interrupted(tmp_path):
    run("dataset.py", "--folder", "data")
    file = tmp_path / "data" / "manifest.jsonl"
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join(lines[:3]) + lines[3][:40])
    assert "1 of 4 images" in run("dataset.py", "--folder", "data")
    assert "0 of 4 images" in run("dataset.py", "--folder", "data")


def test_workers_of_ray_make_the_same_images(tmp_path):
    pytest.importorskip("ray")
    run("dataset.py", "--folder", "alone", "--shard", "2/4")
    run("dataset_ray.py", "--folder", "together")
    alone, together = manifest(tmp_path / "alone"), manifest(tmp_path / "together")
    assert together[1:2] == alone and len(together) == 4
    assert same_arrays(tmp_path / "alone" / "000001.npz", tmp_path / "together" / "000001.npz")


def test_arrays_and_cameras_of_a_data_set_belong_together(tmp_path):
    """Depths, along rays of K and the pose, meet the table where its mask is."""
    run("dataset.py", "--folder", "data", "--shard", "1/4")
    (line,) = manifest(tmp_path / "data")
    arrays = np.load(tmp_path / "data" / line["files"][2])
    table = next(int(number) for number, name in line["nodes"].items() if name == "table")
    rows, columns = np.nonzero(arrays["node"] == table)
    K, pose = np.array(line["K"]), np.array(line["camera_to_world"])
    assert np.array_equal(K, arrays["K"]) and np.array_equal(pose, arrays["camera_to_world"])
    rays = np.stack([columns + 0.5, rows + 0.5, np.ones(len(rows))]).T @ np.linalg.inv(K).T * [1, -1, -1]
    up = arrays["normal"][rows, columns, 1] > 0.99
    points = (rays * arrays["depth"][rows, columns][:, None])[up] @ pose[:3, :3].T + pose[:3, 3]
    assert up.sum() > 100 and np.median(np.abs(points[:, 1] - np.median(points[:, 1]))) < 0.02


def test_notebook(monkeypatch):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(EXAMPLES / "notebook.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # it is stored without
    monkeypatch.setenv("PYTHONPATH", ENVIRONMENT["PYTHONPATH"])
    nbclient.NotebookClient(notebook, timeout=900, kernel_name="python3",
                            resources={"metadata": {"path": str(EXAMPLES)}}).execute()
    shown = [output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", [])]
    assert sum("image/png" in data for data in shown) == 4
    assert sum("<table>" in data.get("text/html", "") for data in shown) == 1

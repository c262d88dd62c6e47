#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders 40 models under 4 probes without any option but a quality, and puts the pictures on one sheet:

    tools/scripts/contact_sheet.py DATA OUT.jpg [QUALITY]

DATA has the folders `gltf`, of the Khronos sample models and others, and `probes`. Prints how long each took."""
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "scripts" / "shared"))
import jpeg  # noqa: E402
from pixels import read_png  # noqa: E402

PROBES = ["studio_small_05_1k", "venice_sunset_1k", "kloppenheim_05_1k", "pmndrs_lobby"]  # of Poly Haven, CC0
MODELS = """
    AlphaBlendModeTest AnimatedMorphCube AnisotropyStrengthTest AttenuationTest
    BoxTextured BoxVertexColors Cameras ClearCoatTest
    CornellBox DamagedHelmet EmissiveStrengthTest Fox
    InterpolationTest LightsPunctualLamp MeshPrimitiveModes MetalRoughSpheresNoTextures
    MorphPrimitivesTest MultipleScenes MultiUVTest NegativeScaleTest
    NormalTangentTest OrientationTest RiggedFigure SheenCloth
    SimpleInstancing SimpleMeshes SimpleMorph SimpleSkin
    Suzanne TextureCoordinateTest TextureSettingsTest TextureTransformTest
    TransmissionTest TwoSidedPlane UnlitTest WaterBottle
    interiors/apartment interiors/glass_table interiors/home_theater interiors/living_room""".split()
COLUMNS, CELL = 8, (160, 120)


def render(model, probe, quality, out):
    start = time.monotonic()
    run = subprocess.run([ROOT / "build" / "chromeball", "render", model, "--probe", probe, "--quality", quality, "-o",
                          out], capture_output=True, text=True)
    print(f"{time.monotonic() - start:5.1f} s  {model.name}, {probe.stem}\n{run.stderr}", end="", flush=True)
    if run.returncode != 0:
        sys.exit(1)
    return fitted(read_png(out))


def fitted(rows):
    """In the middle of a cell, each pixel the mean of those that it covers."""
    scale = max(len(rows[0]) / CELL[0], len(rows) / CELL[1])
    left, top = (round(CELL[i] - side / scale) // 2 for i, side in enumerate((len(rows[0]), len(rows))))

    def mean(x, y):
        x0, x1, y0, y1 = (round(scale * v) for v in (x - left, x - left + 1, y - top, y - top + 1))
        pixels = [pixel for row in rows[max(y0, 0):max(y1, 0)] for pixel in row[max(x0, 0):max(x1, 0)]]
        return tuple(round(sum(channel) / len(pixels)) for channel in zip(*pixels)) if pixels else (40, 40, 40)

    return [[mean(x, y) for x in range(CELL[0])] for y in range(CELL[1])]


def main(data, out, quality="draft"):
    data = pathlib.Path(data)
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        for i, name in enumerate(MODELS):
            files = sorted(file for file in (data / "gltf" / name).rglob("*.gl*")
                           if file.suffix in (".gltf", ".glb") and "Draco" not in str(file))
            probe = data / "probes" / "polyhaven" / f"{PROBES[(i + i // COLUMNS) % len(PROBES)]}.hdr"
            pictures.append(render(files[0], probe, quality, pathlib.Path(folder) / "picture.png"))
    bands = [pictures[i:i + COLUMNS] for i in range(0, len(pictures), COLUMNS)]
    jpeg.write(out, [[pixel for picture in band for pixel in picture[y]] for band in bands
                     for y in range(CELL[1])])


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])

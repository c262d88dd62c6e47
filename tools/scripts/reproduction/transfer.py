# SPDX-License-Identifier: Apache-2.0
"""Precomputed radiance transfer at vertices: HDRI's 9.9.2, figure 9.46."""
import array
import json
import struct

from gltf import Model
from page import Row, table
from pfm import read_pfm
from run import NOON, ROOT, SCENES

STILL_LIFE = SCENES / "models" / "still-life.glb"
PILLARS = SCENES / "models" / "pillars.gltf"
DUSK = ROOT / "probes" / "dusk.exr"
SAMPLES = 4096
FLOOR, TILES = 4, 12  # metres, a side
EYE, WHITE = (0, 0.5, 4), 16
BASES = {"sh:2": [9], "sh:4": [25], "haar:16": [25, 100, 1536]}


def irradiance(path):
    """The attribute _IRRADIANCE of all primitives of a .glb, as floats in the order of the file."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + length])
    found = array.array("f")
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            accessor = document["accessors"][primitive["attributes"]["_IRRADIANCE"]]
            view = document["bufferViews"][accessor["bufferView"]]
            start = 28 + length + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            found.frombytes(data[start:start + 12 * accessor["count"]])
    return found


def relative_rms(part, whole):
    squares = sum(value * value for value in whole)
    return (sum((a - b) ** 2 for a, b in zip(part, whole)) / squares) ** 0.5


def errors(run):
    """Rows of the table: the error of each basis and count by probe; and the names of the probes."""
    probes = {**run.probes(["Grace Cathedral", "St Peter's", "Uffizi"]), "noon": NOON, "dusk": DUSK}
    baked = {}
    for name, probe in probes.items():
        run("bake", PILLARS, "--probe", probe, "--to", "vertices", "--samples", SAMPLES, "--seed", 1, "--quiet",
            "-o", run.scratch / "baked.glb")
        baked[name] = irradiance(run.scratch / "baked.glb")
    rows = []
    for basis, counts in BASES.items():
        run("basis", PILLARS, "--at", "vertices", "--basis", basis, "--samples", SAMPLES, "--quiet",
            "-o", run.scratch / "transfer.glb")
        for count in counts:
            row = [f"`{basis}`, {count} coefficients"]
            for name, probe in probes.items():
                run("relight", run.scratch / "transfer.glb", "--probe", probe, "--keep", count, "--quiet",
                    "-o", run.scratch / "lit.glb")
                row.append(f"{100 * relative_rms(irradiance(run.scratch / 'lit.glb'), baked[name]):.2g}%")
            rows.append(row)
    return rows, list(probes)


def ball_over_floor(run, roughness):
    """A ball of metal over a floor of the same, of small triangles."""
    model = Model()
    metal = model.material((0.7, 0.7, 0.7), roughness, 1)
    model.sphere("ball", metal, (0, 0, 0), 0.5, 32, 16)
    side = FLOOR / TILES
    model.quads("floor", metal, [((-FLOOR / 2 + x * side, -0.55, FLOOR / 2 - z * side), (side, 0, 0), (0, 0, -side))
                                 for x in range(TILES) for z in range(TILES)])
    model.write(run.scratch / "glossy.gltf")
    return run.scratch / "glossy.gltf"


def seen(run, model, out, *options):
    scene = run.scratch / "eye.toml"
    scene.write_text(f'model = "{model}"\n[camera]\nposition = [{", ".join(map(str, EYE))}]\nlook_at = [0, 0, 0]\n'
                     "fov = 30\n")
    image = run.render(scene, out, "--size", "60x45", "--samples", 256, "--adaptive", "off", "--transparent", *options)
    return [channel for row in read_pfm(image) for pixel in row for channel in pixel]


def glossy(run):
    """Rows: roughness, and the error of glossy transfer by probe; and the names of the probes."""
    probes = {**run.probes(["Uffizi"]), "dusk": DUSK}
    rows = []
    for roughness in (0.3, 0.5, 0.7, 1.0):
        model = ball_over_floor(run, roughness)
        run("basis", model, "--at", "vertices", "--basis", "sh:4", "--glossy", "--clusters", 64, "--vectors", 24,
            "--samples", 512, "-o", run.scratch / "glossy.glb")
        row = [roughness]
        for probe in probes.values():
            run("relight", run.scratch / "glossy.glb", "--probe", probe, "--view", ",".join(map(str, EYE)), "--white",
                WHITE, "-o", run.scratch / "lit.glb")
            lit = seen(run, run.scratch / "lit.glb", "lit.pfm", "--probe", probe)
            rendered = seen(run, model, "rendered.pfm", "--probe", probe)
            row.append(f"{100 * relative_rms([WHITE * value for value in lit], rendered):.2g}%")
        rows.append(row)
    return rows, list(probes)


def views(run):
    """Two views of a lit model: the colours of its vertices are all that they show."""
    run("basis", STILL_LIFE, "--at", "vertices", "--basis", "sh:4", "--samples", 256, "-o", run.scratch / "sh.glb")
    run("relight", run.scratch / "sh.glb", "--probe", DUSK, "-o", run.scratch / "lit.glb")
    pictures = []
    for name, position in {"front": "[0.3, 1.3, 5.4]", "left": "[-4, 2, 3.6]"}.items():
        scene = run.scratch / f"{name}.toml"
        scene.write_text(f'model = "lit.glb"\n[camera]\nposition = {position}\nlook_at = [0, 0.6, 0]\nfov = 29\n')
        image = run.render(scene, f"{name}.exr", "--size", "320x240", "--samples", 16)
        pictures.append((run.picture(image, f"transfer-{name}.png"), f"Dusk by `sh:4`, from the {name}"))
    return pictures


def rows(run):
    measured, names = errors(run)
    glossy_rows, glossy_names = glossy(run)
    return [Row(
        "HDRI 9.9.2 and figure 9.46: precomputed radiance transfer",
        "Transfer vectors on the geometry relight it in real time from any side: by spherical harmonics under "
        "low-frequency light, by Haar wavelets with detailed shadows.",
        ["chromeball basis scenes/models/pillars.gltf --at vertices --basis haar:16 -o PRT.glb",
         "chromeball relight PRT.glb --probe PROBE --keep 100 -o LIT.glb"],
        "Irradiance at the 100 vertices of the pillars against `bake --to vertices`, root of the sum of squared differences over "
        f"that of the squares ({SAMPLES} samples of each vertex in both):\n\n" +
        table(["light", *names], measured)
        + "\n\nA metal ball over a floor of the same metal, seen from one side, by glossy transfer (`sh:4`, 64 clusters of "
        "24 vectors), against a render:\n\n" + table(["roughness", *glossy_names], glossy_rows),
        "The figure has no numbers. 25 wavelets have .5 to 2.4 times the error of 25 harmonics, 100 are closer, but for the noise of "
        "noon: few paths find the one cell of the sun, and the error falls with the root of the samples, to 4% with 65536.", views(run))]

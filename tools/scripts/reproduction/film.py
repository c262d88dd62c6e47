# SPDX-License-Identifier: Apache-2.0
"""What the two films show: HDRI's figures 9.3, 9.4 and 9.30."""
import base64
import json
import struct

from gallery import scene_of
from page import Row
from run import NOON

TONES = ["--tonemap", "neutral"]
SMALL = ["--samples", 128, "--denoise"]
MIX = ".75:0.5,.15:3,.07:12,.03:48"


def pedestal(run):
    image = run.render(scene_of(run, "rnl"), "rnl.exr", *SMALL, "--size", "240x240")
    run("image", "develop", image, run.pictures / "film-developed.png", "--bloom", MIX, "--vignette", 0.6, *TONES)
    return Row(
        "HDRI figures 9.3 and 9.4: Rendering with Natural Light",
        "A pedestal with balls of glass, metal and plastic stands in a large box, onto whose walls the light probe of a "
        "grove is mapped; the frames are shown before and after blooming and vignetting.",
        ["build/make_demo rnl out/rnl.glb && chromeball render scenes/rnl.toml",
         f"chromeball image develop out/rnl.exr out/developed.png --bloom {MIX} --vignette 0.6"],
        "A pedestal of this project in a box of 24 x 14 x 24 metres with its dusk.",
        "The model and the probe are this project's own: the film's are not published for use.",
        [(run.picture(image, "film-rendered.png", *TONES), "As rendered"),
         ("film-developed.png", "With bloom and vignetting")])


def animate(glb, name, times, translations):
    """Moves a node of a binary glTF file."""
    data = glb.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    model, rest = json.loads(data[20:20 + length]), data[20 + length:]
    moves = struct.pack(f"<{len(times)}f", *times) + b"".join(struct.pack("<3f", *t) for t in translations)
    model["buffers"].append({"byteLength": len(moves), "uri": "data:application/octet-stream;base64,"
                             + base64.b64encode(moves).decode()})
    buffer, view, accessor = len(model["buffers"]) - 1, len(model["bufferViews"]), len(model["accessors"])
    split = 4 * len(times)
    model["bufferViews"] += [{"buffer": buffer, "byteOffset": 0, "byteLength": split},
                             {"buffer": buffer, "byteOffset": split, "byteLength": len(moves) - split}]
    model["accessors"] += [{"bufferView": view, "componentType": 5126, "count": len(times), "type": "SCALAR",
                            "min": [times[0]], "max": [times[-1]]},
                           {"bufferView": view + 1, "componentType": 5126, "count": len(times), "type": "VEC3"}]
    node = next(i for i, n in enumerate(model["nodes"]) if n.get("name") == name)
    model["animations"] = [{"samplers": [{"input": accessor, "output": accessor + 1}],
                            "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]}]
    text = json.dumps(model).encode()
    text += b" " * (-len(text) % 4)
    glb.write_bytes(struct.pack("<III", 0x46546C67, 2, 20 + len(text) + len(rest))
                    + struct.pack("<II", len(text), 0x4E4F534A) + text + rest)


def hopping(run):
    scene = scene_of(run, "five-shapes")
    glb = run.scratch / "five-shapes.glb"
    plain = glb.read_bytes()
    animate(glb, "steel ball", [0, 0.1], [[0, 0, 0], [0.05, 0.35, 0]])
    common = [*SMALL, "--size", "240x150", "--animation-time", 0, "--probe", NOON]
    still = run.render(scene, "still.exr", *common)
    moving = run.render(scene, "moving.exr", *common, "--fps", 10, "--shutter", 0.5)
    glb.write_bytes(plain)  # for other rows
    pictures = [(run.picture(still, "film-still.png", *TONES), "An instant"),
                (run.picture(moving, "film-moving.png", *TONES), "The ball hops while the shutter is open")]
    return Row(
        "HDRI figure 9.30: objects that move, and their reflections",
        "A frame of Fiat Lux has the streaks that bright reflections draw on objects that move: motion blur of high "
        "dynamic range.",
        ["chromeball render five-shapes-that-hop.toml --animation-time 0 --fps 10 --shutter 0.5"],
        "Every sample has its own time, and so have its shadow rays and reflections. That the light of a moving "
        "highlight is that of a still one, and the image the mean of stills, are tests of the project.",
        "Other objects than the film's.", pictures)


def rows(run):
    return [pedestal(run), hopping(run)]

# SPDX-License-Identifier: Apache-2.0
"""Equal-time images of hard light by each way of rendering, and by Cycles; see hard_light.sh.

Each renderer's errors are measured against its own reference, so that small differences between the
two (a filter, a Fresnel term) do not count as noise. Every image renders for --seconds; denoising
takes the time in the table's column `seconds` besides.
"""
import argparse
import hashlib
import html
import json
import pathlib
import statistics
from dataclasses import dataclass

import cycles
from cycles import run

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHROMEBALL = ROOT / "build" / "chromeball"

WAYS = {
    "unguided": ["--guide", "off"],
    "guided": [],
    "regularized": ["--regularize"],
    "denoised": ["--denoise"],
    "regularized, denoised": ["--regularize", "--denoise"],
}
CYCLES_WAYS = {"Cycles": False, "Cycles, its defaults": True}


@dataclass
class Scene:
    name: str
    model: str  # of make_demo, a scene file, or a path in the data's folder gltf/
    probe: str = ""  # a path in the data's folder probes/; the project's dusk if empty
    crop: tuple = (0.5, 0.5)  # centre of the enlarged part
    camera: dict = None  # of a model without one
    scale: float = 1  # of the probe
    depth: int = 8


def camera(position, look_at, fov):
    return {"position": position, "look_at": look_at, "fov": fov}


SCENES = [
    Scene("demo", "scenes/demo.toml", scale=1.5, crop=(0.33, 0.62)),
    Scene("terrace", "scenes/terrace.toml", crop=(0.5, 0.7)),
    Scene("caustics, Grace", "caustics", "debevec/grace_probe.hdr", crop=(0.55, 0.75)),
    Scene("caustics, St Peter's", "caustics", "debevec/stpeters_cross.hdr", crop=(0.55, 0.75)),
    Scene("glass over a table", "glass", "debevec/galileo_probe.hdr", crop=(0.5, 0.7)),
    Scene("room with one window", "room", "polyhaven/qwantani_afternoon_puresky_1k.hdr"),
    Scene("lamp behind glass", "lamp"),
    Scene("living room", "interiors/living_room/living_room.glb",
          "polyhaven/kloppenheim_05_1k.hdr", camera=camera([3.5, 2.2, 1.8], [-1, 1.2, 0], 55)),
    Scene("apartment", "interiors/apartment/DreamApartment.glb",
          "polyhaven/qwantani_afternoon_puresky_1k.hdr",
          camera=camera([12.06, 1.43, -6.92], [10.4, 1.23, -5.81], 60)),
    Scene("glass table", "interiors/glass_table/glass-table.glb",
          "polyhaven/qwantani_afternoon_puresky_1k.hdr",
          camera=camera([2.5, 2.6, 3.5], [0, 0.6, 0], 40)),
]


def arguments():
    parser = argparse.ArgumentParser(prog="hard_light.sh", description=__doc__.split("\n")[0])
    parser.add_argument("--scenes", nargs="+", metavar="NAME", help="; ".join(s.name for s in SCENES))
    parser.add_argument("--size", default="240x160")
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--reference-seconds", type=float, default=150)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data",
                        help="with the folders probes/ and gltf/; scenes that it lacks are skipped")
    parser.add_argument("--no-cycles", action="store_true")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "out" / "hard-light")
    return parser.parse_args()


class Comparison:
    """One scene: its files, references, images and errors."""

    def __init__(self, options, scene):
        self.options, self.scene = options, scene
        self.folder = options.output / "".join(c if c.isalnum() else "-" for c in scene.name)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.is_file = scene.model.endswith(".toml")
        self.composite = self.is_file and "[composite]" in (ROOT / scene.model).read_text()
        self.own = "/" not in scene.model
        self.cycles = not options.no_cycles and not self.composite

    def missing(self):
        wanted = [self.options.data / "probes" / self.scene.probe]
        if not self.own and not self.is_file:
            wanted.append(self.options.data / "gltf" / self.scene.model)
        return [path for path in wanted if not path.exists()]

    def prepare(self):
        """The scene file, the model and the lat-long probe."""
        scene, self.probe = self.scene, ROOT / "probes" / "dusk.exr"
        if scene.probe:
            self.probe = self.folder / "probe.exr"
            run(CHROMEBALL, "probe", "convert", self.options.data / "probes" / scene.probe,
                self.probe, "--to", "lat-long")
        if self.is_file:
            self.model = ROOT / "scenes" / "models" / "still-life.glb"
            self.file = ROOT / scene.model
            return
        if self.own:
            self.model = self.folder / "model.glb"
            run(ROOT / "build" / "make_demo", scene.model, self.model)
        else:
            self.model = (self.options.data / "gltf" / scene.model).resolve()
        view = "".join(f"{key} = {value}\n" for key, value in (scene.camera or {}).items())
        self.file = self.folder / "scene.toml"
        self.file.write_text(f'model = "{self.model}"\n[camera]\n{view}\n'
                             f'[probe]\nfile = "{self.probe}"\n')

    def key(self):
        text = repr((self.options.size, self.options.reference_seconds, self.scene))
        return hashlib.sha1(self.model.read_bytes() + text.encode()).hexdigest()[:8]

    def render(self, way, output, seconds, seed):
        """Returns the seconds of rendering and denoising, and the samples per pixel."""
        stats = output.with_suffix(".json")
        run(CHROMEBALL, "render", self.file, "--size", self.options.size, "--time", seconds,
            "--max-depth", self.scene.depth, "--threads", self.options.threads, "--seed", seed,
            "--allow-external", "--stats", stats, "--quiet", "-o", output, *WAYS[way])
        found = json.loads(stats.read_text())
        return found["seconds"]["render"], found["samples_per_pixel"]

    def render_cycles(self, defaults, output, seconds, seed):
        size = tuple(int(number) for number in self.options.size.split("x"))
        return cycles.render(cycles.Settings(
            str(self.model), str(self.probe), str(output), size, 1 << 20, seed,
            self.options.threads, self.scene.depth, seconds=seconds, defaults=defaults,
            plain_materials=self.own, camera=self.scene.camera, scale=self.scene.scale))

    def reference(self, name, render):
        path = self.folder / f"reference-{name}-{self.key()}.exr"
        if not path.exists():
            partial = path.with_suffix(".part.exr")
            render(partial, self.options.reference_seconds, 1_000_003)
            partial.rename(path)
        return path

    def image(self, renderer, way):
        return self.folder / f"{renderer}-{way.replace(', ', '-').replace(' ', '-')}.exr"

    def rows(self):
        """(way, relMSE, FLIP, seconds, samples, picture) of each way."""
        ways = [("chromeball", way, lambda *a, way=way: self.render(way, *a)) for way in WAYS]
        references = {"chromeball": self.reference(
            "chromeball", lambda *a: self.render("guided", *a))}
        if self.cycles:
            ways += [("cycles", way, lambda *a, d=d: self.render_cycles(d, *a))
                     for way, d in CYCLES_WAYS.items()]
            references["cycles"] = self.reference(
                "cycles", lambda *a: self.render_cycles(False, *a))
            self.apart = error(references["chromeball"], references["cycles"])
        found = [[] for _ in ways]
        for seed in range(1, self.options.seeds + 1):
            for row, (renderer, way, render) in zip(found, ways):
                image = self.image(renderer, way)
                taken, samples = render(image, self.options.seconds, seed)
                apart = error(image, references[renderer])
                row.append((apart["relmse"], apart["flip"], taken, samples))
        rows = []
        for row, (renderer, way, _) in zip(found, ways):
            image = self.image(renderer, way)
            means = [statistics.mean(column) for column in zip(*row)]
            rows.append((way, *means, picture(image)))
        rows.append(("reference", None, None, None, None, picture(references["chromeball"])))
        return rows


def error(image, reference):
    return json.loads(run(CHROMEBALL, "image", "error", image, reference, "--flip", "--json"))


def picture(image):
    path = image.with_suffix(".png")
    run(CHROMEBALL, "image", "view", image, path, "--tonemap", "aces", "--exposure", 0)
    return path


def table(rows):
    yield "| way | relMSE | FLIP | seconds | samples | gain |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    base = rows[0][1] * rows[0][3]
    for way, relmse, flip, seconds, samples, _ in rows:
        if relmse is not None:
            yield (f"| {way} | {relmse:.2e} | {flip:.4f} | {seconds:.1f} | {samples:.0f} | "
                   f"{base / (relmse * seconds):.2f} |")


STYLE = """body{font:15px sans-serif;background:#222;color:#ddd;margin:2em}
figure{display:inline-block;margin:0 8px 12px 0;vertical-align:top}
figcaption{font-size:13px;max-width:240px}
.crop{width:240px;height:160px;overflow:hidden;image-rendering:pixelated}
td,th{padding:2px 10px;text-align:right}"""


def page(options, sections):
    width, height = (int(number) for number in options.size.split("x"))
    parts = [f"<!doctype html><meta charset=utf-8><title>Hard light</title><style>{STYLE}</style>",
             f"<h1>Hard light, {options.seconds:g} seconds on {options.threads} threads</h1>"]
    for scene, rows in sections:
        parts.append(f"<h2>{html.escape(scene.name)}</h2>")
        for way, relmse, flip, seconds, _, image in rows:
            source = image.relative_to(options.output)
            numbers = "" if relmse is None else (
                f"<br>relMSE {relmse:.2e}, FLIP {flip:.3f}, {seconds:.1f} s")
            x, y = (min(max(3 * size * centre - half, 0), 3 * size - 2 * half) for size, centre, half
                    in ((width, scene.crop[0], 120), (height, scene.crop[1], 80)))
            parts.append(
                f'<figure><img src="{source}" width={width} height={height}><div class=crop '
                f'style="background:url({source}) -{x:.0f}px -{y:.0f}px/{3 * width}px"></div>'
                f"<figcaption><b>{html.escape(way)}</b>{numbers}</figcaption></figure>")
    (options.output / "index.html").write_text("\n".join(parts))


def main():
    options = arguments()
    options.output = options.output.resolve()
    sections = []
    for scene in SCENES:
        if options.scenes and scene.name not in options.scenes:
            continue
        comparison = Comparison(options, scene)
        if missing := comparison.missing():
            print(f"{scene.name}: skipped, no {missing[0]}")
            continue
        comparison.prepare()
        rows = comparison.rows()
        print(f"\n{scene.name}\n\n" + "\n".join(table(rows)), flush=True)
        if comparison.cycles:
            print(f"\nThe references differ by {100 * comparison.apart['bias']:+.2f}% in their "
                  f"means, relMSE {comparison.apart['relmse']:.1e}.", flush=True)
        sections.append((scene, rows))
        page(options, sections)
    print(f"\n{options.output / 'index.html'}")


main()

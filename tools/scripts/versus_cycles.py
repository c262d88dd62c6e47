# SPDX-License-Identifier: Apache-2.0
"""Error and time of chromeball and of Cycles for the same image; see versus_cycles.sh.

Each renderer's relMSE is measured against its own reference, so that small differences between the
two (a filter, a Fresnel term) do not count as noise; the last line of the table compares the
references. The noise of a reference increases each relMSE by the factor 1 + samples / reference
samples, the same for both renderers, so their ratio is unaffected. Only rendering is timed: no
loading, no building of the BVH or of the probe's tables. relMSE is proportional to 1/samples, so
relMSE x seconds does not depend on the number of samples; the ratio of the two products is the
ratio of the times that the renderers need for the same error. That is not so for the biased images of
--approximate and --cycles-defaults: their products compare only this number of samples.
"""
import argparse
import hashlib
import json
import pathlib
import statistics

import cycles
from cycles import run

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "versus"
CHROMEBALL = ROOT / "build" / "chromeball"
SCENES = ("lambertian", "conductors", "glass", "plastics", "room", "caustics", "fine")


def arguments():
    parser = argparse.ArgumentParser(prog="versus_cycles.sh", description=__doc__.split("\n")[0])
    parser.add_argument("--probe", type=pathlib.Path, default=ROOT / "probes" / "dusk.exr",
                        help="a lat-long map (make one with chromeball probe convert)")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=SCENES)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--reference-samples", type=int, default=4096)
    parser.add_argument("--depth", type=int, default=5, help="scattering events")
    parser.add_argument("--seeds", type=int, default=5, help="images by each renderer")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--strategy", default="auto", help="chromeball's")
    parser.add_argument("--approximate", default="", metavar="OPTIONS",
                        help="for chromeball's images, not its reference: '--regularize --denoise'")
    parser.add_argument("--cycles-defaults", action="store_true",
                        help="Cycles' images, not its reference, with its default clamp of indirect "
                             "light to 10 and Filter Glossy of 1")
    return parser.parse_args()


class Chromeball:
    name = "chromeball"

    @staticmethod
    def render(options, model, output, samples, seed, approximate=False):
        """Returns the seconds of rendering."""
        stats = output.with_suffix(".json")
        run(CHROMEBALL, "render", model, "--probe", options.probe, "--probe-mapping", "lat-long",
            "--size", options.size, "--samples", samples, "--max-depth", options.depth,
            "--strategy", options.strategy, "--seed", seed, "--threads", options.threads,
            "--stats", stats, "--quiet", "-o", output,
            *(options.approximate.split() if approximate else []))
        return json.loads(stats.read_text())["seconds"]["render"]


class Cycles:
    name = "Cycles"

    @staticmethod
    def render(options, model, output, samples, seed, approximate=False):
        """Returns the seconds of rendering."""
        return cycles.render(cycles.Settings(
            str(model), str(options.probe), str(output),
            tuple(int(number) for number in options.size.split("x")), samples, seed,
            options.threads, options.depth, defaults=approximate and options.cycles_defaults))[0]


def error(image, reference):
    return json.loads(run(CHROMEBALL, "image", "error", image, reference, "--json"))


def reference(options, renderer, model):
    """Rendered once for each model, probe and setting."""
    key = hashlib.sha1(model.read_bytes() + options.probe.read_bytes() + repr(
        (options.size, options.reference_samples, options.depth)).encode()).hexdigest()[:12]
    path = WORK / f"reference-{renderer.name}-{model.stem}-{key}.exr"
    if not path.exists():
        print(f"rendering {path.name}", flush=True)
        partial = path.with_suffix(".part.exr")
        renderer.render(options, model, partial, options.reference_samples, 1_000_003)
        partial.rename(path)
    return path


def compare(options, scene):
    model = WORK / f"{scene}.glb"
    run(ROOT / "build" / "make_demo", scene, model)
    renderers = (Chromeball, Cycles)
    references = {r: reference(options, r, model) for r in renderers}
    errors, seconds = {r: [] for r in renderers}, {r: [] for r in renderers}
    for seed in range(1, options.seeds + 1):
        for r in renderers:  # in turns: a change of the machine's speed affects both
            image = WORK / f"{r.name}-{scene}.exr"
            seconds[r].append(r.render(options, model, image, options.samples, seed, True))
            errors[r].append(error(image, references[r])["relmse"])

    width, height = map(int, options.size.split("x"))
    print(f"\n{scene}: {options.probe.name}, {options.size}, {options.samples} samples per pixel, "
          f"depth {options.depth}, {options.threads} threads, {options.seeds} seeds, "
          f"references of {options.reference_samples} samples")
    print(f"{'':12}{'relMSE':>12}{'seconds':>10}{'Msamples/s':>12}{'relMSE x s':>12}")
    product = {}
    for r in renderers:
        mean_error, median_seconds = statistics.mean(errors[r]), statistics.median(seconds[r])
        product[r] = mean_error * median_seconds
        rate = width * height * options.samples / median_seconds / 1e6
        print(f"{r.name:12}{mean_error:12.3e}{median_seconds:10.2f}{rate:12.2f}{product[r]:12.3e}")
    apart = error(references[Chromeball], references[Cycles])
    ratio = product[Cycles] / product[Chromeball]
    print(f"Cycles takes {ratio:.2f} times as long for the same error. "
          f"The references differ by {100 * apart['bias']:+.3f}% in their means, "
          f"relMSE {apart['relmse']:.2e}.", flush=True)


def main():
    options = arguments()
    options.probe = options.probe.resolve()
    WORK.mkdir(parents=True, exist_ok=True)
    print(run("blender", "--version").splitlines()[0], "and", run(CHROMEBALL, "--version").strip())
    for scene in options.scenes:
        compare(options, scene)


main()

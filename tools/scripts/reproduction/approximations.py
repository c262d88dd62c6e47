# SPDX-License-Identifier: Apache-2.0
"""Environment mapping, ambient occlusion and the irradiance cache: HDRI's 9.5, figures 9.39 and 9.41."""
import time

from page import Row, table
from run import NOON, SCENES

STILL_LIFE = SCENES / "models" / "still-life.glb"
PILLARS = SCENES / "models" / "pillars.gltf"
COMMON = ["--size", "240x160", "--adaptive", "off"]
TONES = ["--tonemap", "neutral"]


def compared(run, image, reference):
    error = run.error(image, reference, "--flip")
    return [f"{error['relmse']:.3g}", f"{100 * error['bias']:+.0f}%", f"{error['flip']:.3f}"]


def lights(run):
    """Name: probe, strategy, whether its pictures may be copied."""
    overcast = run.scratch / "overcast.exr"
    run("probe", "synth", "overcast", overcast, "--size", "512x256")
    found = {"overcast": (overcast, "importance"), "noon": (NOON, "suns")}
    if grace := run.probe("Grace Cathedral"):
        found["Grace Cathedral"] = (grace, "importance")
    return found


def environment_mapping(run):
    rows, pictures = [], []
    for name, (probe, strategy) in lights(run).items():
        common = [*COMMON, "--probe", probe, "--strategy", strategy]
        traced = run.reference(STILL_LIFE, "traced.exr", *common, "--samples", 512)
        mapped = run.render(STILL_LIFE, "mapped.exr", *common, "--samples", 32, "--integrator", "environment-map")
        rows.append([name, *compared(run, mapped, traced)])
        if name == "noon":
            run("image", "error", mapped, traced, "--map", "flip", "-o", run.pictures / "mapping-difference.png")
            pictures = [(run.picture(traced, "mapping-traced.png", *TONES), "Noon, path traced"),
                        (run.picture(mapped, "mapping-mapped.png", *TONES), "Noon, environment mapped"),
                        ("mapping-difference.png", "Their difference (FLIP)")]
    return Row(
        "HDRI 9.8.1 and figure 9.39: environment mapping against image-based lighting",
        "Environment maps light each surface as if it were alone: no shadows, nothing reflects anything but the probe.",
        ["chromeball render scenes/models/still-life.glb --probe PROBE --integrator environment-map "
         "[--strategy suns] --adaptive off -o OUT.exr"],
        "Environment mapping against paths:\n\n" + table(["probe", "relMSE", "bias", "FLIP"], rows),
        "On a convex object alone the two are the same, as a test of the project shows on a sphere. Noon alone has "
        "`--strategy suns`: its suns are split off and cast shadows, so that its error is that of the sky.", pictures)


def ambient_occlusion(run):
    rows, pictures = [], []
    for name, (probe, strategy) in lights(run).items():
        common = [*COMMON, "--probe", probe]
        traced = run.reference(PILLARS, "traced.exr", *common, "--samples", 512)
        ways = {"E(n) alone": ["environment-map", "importance"], "occluded": ["ambient-occlusion", "importance"],
                "occluded, suns apart": ["ambient-occlusion", "suns"]}
        for way, (integrator, how) in ways.items():
            if how == "suns" and strategy != "suns":
                continue
            out = run.render(PILLARS, f"{integrator}-{how}.exr", *common, "--samples", 64, "--integrator", integrator,
                             "--strategy", how, "--aov", "ao")
            rows.append([f"{name}, {way}", *compared(run, out, traced)])
        if name == "overcast":
            pictures = [
                (run.picture("ambient-occlusion-importance.exr", "occlusion-ao.png", "--layer", "ao"), "The layer `ao`"),
                (run.picture("environment-map-importance.exr", "occlusion-without.png", *TONES), "Overcast, E(n) alone"),
                (run.picture("ambient-occlusion-importance.exr", "occlusion-with.png", *TONES), "Overcast, occluded"),
                (run.picture(traced, "occlusion-traced.png", *TONES), "Overcast, path traced")]
    return Row(
        "HDRI 9.8.2 and figure 9.41: ambient occlusion",
        "Occlusion makes the light of an environment map plausible; key lights are better treated apart.",
        ["chromeball render scenes/models/pillars.gltf --probe PROBE --integrator ambient-occlusion "
         "[--strategy suns] --adaptive off -o AO.exr",
         "chromeball render scenes/models/pillars.gltf --probe PROBE --integrator ambient-occlusion --aov albedo,normal,ao,"
         "bent_normal -o LAYERS.exr",
         "chromeball image relight LAYERS.exr --probe OTHER -o LIT.exr"],
        "Against paths:\n\n" + table(["light", "relMSE", "bias", "FLIP"], rows),
        "What is left is light between the surfaces. With occlusion there are shadows of contact, and the picture is too "
        "dark; without it, missing shadows and missing interreflection nearly cancel, so that under the overcast sky "
        "the numbers of the picture without shadows are the better ones. Where one sun dominates, "
        "occlusion without its shadows is no picture of the scene; with the sun apart it is.", pictures)


def irradiance_cache(run):
    light = ["--probe", NOON, "--strategy", "suns"]

    def timed(out, *options):
        start = time.monotonic()
        run.render(PILLARS, out, *COMMON, *light, "--samples", 64, *options)
        return time.monotonic() - start

    reference = run.reference(PILLARS, "reference.exr", *COMMON, *light, "--samples", 2048)
    rows = []
    for name, options in (("paths", []), ("paths, denoised", ["--denoise"]),
                          ("cache, error 0.2", ["--irradiance-cache", 0.2, "--cache", "records"]),
                          ("the same records, other noise",
                           ["--irradiance-cache", 0.2, "--cache", "records", "--seed", 2])):
        seconds = timed("cached.exr", *options)
        rows.append([name, f"{seconds:.1f}", *compared(run, "cached.exr", reference)])
    return Row(
        "HDRI 9.5: irradiance cached and interpolated",
        "RADIANCE computes indirect irradiance at few points; a sequence of a static scene uses them "
        "again, which made the RNL animation several thousand times faster to render.",
        ["chromeball render scenes/models/pillars.gltf --probe probes/noon.exr --strategy suns "
         "--irradiance-cache 0.2 --cache records --adaptive off -o OUT.exr"],
        "64 samples:\n\n" + table(["way", "seconds", "relMSE", "bias", "FLIP"], rows),
        "The cache takes away the noise of the light between surfaces and nothing else. The factor of the text is the "
        "product of records in place of hemispheres at all pixels, and of frames that share them.")


def rows(run):
    return [environment_mapping(run), ambient_occlusion(run), irradiance_cache(run)]

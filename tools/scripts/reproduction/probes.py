# SPDX-License-Identifier: Apache-2.0
"""Facts about probes: mappings, irradiance, harmonics, suns, clipping, numbers of rays."""
import math

from lat_long import solid_angle_mean
from page import Row, table
from pfm import read_pfm
from run import NOON, ROOT, SCENES, luminance

DUSK = ROOT / "probes" / "dusk.exr"
STILL_LIFE = SCENES / "models" / "still-life.glb"
ALL = ["Galileo's Tomb", "Grace Cathedral", "St Peter's", "Uffizi", "Beach", "Ennis", "Lobby", "Studio",
       "Qwantani", "Kloppenheim", "Hilly terrain"]


def mappings(run):
    rows = []
    for mapping, facts in [("mirror-ball", "all texels show the same solid angle"),
                           ("angular", "theta / sin(theta): infinite at the rim"),
                           ("cube-3x2", "3 sqrt(3) = 5.196 in the limit of small texels"),
                           ("lat-long", "sin(theta)")]:
        name = f"noon-{mapping}.exr"
        run("probe", "convert", NOON, name, "--to", mapping, "--size",
            {"lat-long": "512x256", "cube-3x2": "384x256"}.get(mapping, "256x256"))
        report = run.json("probe", "info", name, "--mapping-report")["mapping_report"]
        rows.append([mapping, f"{report['max_over_min']:.4g}", facts])
        if mapping != "lat-long":
            run.picture(name, f"noon-{mapping}.png", "--tonemap", "reinhard")
    return [Row(
        "HDRI 9.4.1 to 9.4.4, figures 9.18 and 9.19: one probe in four mappings",
        "The ball is equal-area, the angular map has a constant radial density, cubes vary by 5.2.",
        ["chromeball probe convert probes/noon.exr OUT.exr --to MAPPING --size WIDTHxHEIGHT",
         "chromeball probe info OUT.exr --mapping-report"],
        "Of 256 x 256 texels; the cube has 384 x 256, the lat-long map 512 x 256:\n\n"
        + table(["mapping", "largest / smallest solid angle of a texel", "closed form"], rows), "",
        [(f"noon-{m}.png", f"The project's noon as {m}") for m in ("mirror-ball", "angular", "cube-3x2")])]


def compare_irradiance(run, file, *more):
    """Mean, maximum in % of the mean; shares of texels below 0 and of the energy that is kept, in %; of the
    irradiance map with these options."""
    for name, options in (("exact.pfm", []), ("other.pfm", more)):
        run("probe", "convolve", file, name, "--kernel", "diffuse", "--size", "64x32", *options)
    exact, other = (read_pfm(run.scratch / name) for name in ("exact.pfm", "other.pfm"))
    rows = [[(sum(a) / 3, abs(sum(a) - sum(b)) / 3, luminance(b) < 0, luminance(a) ** 2,
              (luminance(a) - luminance(b)) ** 2) for a, b in zip(*pair)] for pair in zip(exact, other)]
    mean, error, below = solid_angle_mean([[pixel[:3] for pixel in row] for row in rows])
    energy, lost, _ = solid_angle_mean([[(*pixel[3:], 0) for pixel in row] for row in rows])
    worst = max(pixel[1] for row in rows for pixel in row)
    return 100 * error / mean, 100 * worst / mean, 100 * below, 100 * (1 - lost / energy)


def irradiance(run):
    rows = []
    for name, file in run.probes(ALL).items():
        reduced = compare_irradiance(run, file, "--from-size", "32x16")
        harmonics = compare_irradiance(run, file, "--method", "sh")
        rows.append([name, f"{reduced[0]:.2g} / {reduced[1]:.2g}", f"{harmonics[0]:.2g} / {harmonics[1]:.2g}",
                     f"{harmonics[2]:.2g}", f"{harmonics[3]:.4g}"])
    if not rows:
        return []
    return [Row(
        "HDRI 9.8.1, ML07: irradiance from little data",
        "Nine spherical harmonics keep 99% (HDRI); ML07 integrated every normal for 24 hours, and "
        "found a faster one, by the diffuse convolution of HDRShop, to have \"too many artifacts\".",
        ["chromeball probe convolve PROBE OUT.exr --kernel diffuse --from-size 32x16",
         "chromeball probe convolve PROBE OUT.exr --kernel diffuse --method sh"],
        "Mean / maximum error in percent of the mean irradiance, from a reduction to 32 x 16 texels and from nine "
        "harmonics; with these, the share of the normals whose irradiance is negative, and of the energy (the square of "
        "the irradiance over all normals) that is kept:\n\n"
        + table(["probe", "32 x 16", "harmonics", "negative, %", "energy, %"], rows),
        "The 99% is about the energy, not about the irradiance of a normal. An exact irradiance map takes seconds.")]


def suns(run):
    rows = []
    for name, file in [("noon, of this project", NOON),
                       *run.probes(["Qwantani", "Kloppenheim"]).items()]:
        info = run.json("probe", "info", file)
        for sun in info["suns"]:
            share = luminance(sun["irradiance"]) / (4 * math.pi * luminance(info["mean_radiance"]))
            rows.append([name, f"{100 * share:.0f}%", f"{sun['angle']:.2f}", f"{info['max_over_mean']:.0f}"])
    omega = 2 * math.pi * (1 - math.cos(math.radians(0.5323 / 2)))
    return [Row(
        "HDRI 9.6, figure 9.23: a sunny sky",
        "The sun gives over half of the sky's light, from one hundred-thousandth of its area; its pixels are 100,000 "
        "times brighter than the rest of the sky.",
        ["chromeball probe info PROBE"],
        table(["probe", "share of the sun in all light", "its diameter in the map, degrees", "maximum / mean"],
              rows) + f"\n\nThe Sun's disc is {omega / (2 * math.pi):.3g} of a hemisphere.",
        "A map's sun is wider than the real one, because its texels and its glow count; with a sun of 0.53 degrees the "
        "ratio of the maximum would be about twice as large. The share here is of the light from all sides; the "
        "project's noon has a bright ground.")]


def clipping(run):
    rows = [[name, f"{100 * run.json('probe', 'info', file)['lost_if_clipped_at_white']:.0f}%"]
            for name, file in {"dusk, of this project": DUSK,
                               **run.probes(["Galileo's Tomb", "Grace Cathedral", "St Peter's", "Uffizi", "Qwantani",
                                             "Beach"])}.items()]
    white = 0.18 / luminance(run.json("probe", "info", DUSK)["mean_radiance"])
    run("probe", "edit", DUSK, "clipped.exr", "--clip", 1 / white)
    pictures = []
    for name, probe, text in [("whole", DUSK, "Dusk"), ("clipped", "clipped.exr", "Dusk, clipped at white")]:
        image = run.render(STILL_LIFE, "lit.exr", "--probe", probe, "--size", "240x160", "--samples", 128, "--denoise")
        pictures.append((run.picture(image, f"range-{name}.png", "--tonemap", "neutral"), text))
    return [Row("HDRI figure 9.40: an image of low dynamic range as a probe",
                "Clipped highlights change the light.",
                ["chromeball probe info PROBE", "chromeball probe edit probes/dusk.exr clipped.exr --clip WHITE"],
                "Irradiance that is lost, exposed for a mean of 0.18 and clipped at 1:\n\n"
                + table(["probe", "lost"], rows), "", pictures)]


def rays(run):
    overcast = run.scratch / "overcast.exr"
    run("probe", "synth", "overcast", overcast, "--size", "512x256")
    rows = []
    for name, file in {"an overcast sky": overcast,
                       **run.probes(["Uffizi", "Grace Cathedral", "Galileo's Tomb", "St Peter's", "Qwantani",
                                     "Kloppenheim"]), "noon, of this project": NOON}.items():
        counts = run.json("probe", "rays", file, "--size", "256x128")["rays"]
        rows.append([name] + [f"{counts[sampling]['upward']:,}" for sampling in ("uniform", "cosine", "luminance")])
    return [Row(
        "HDRI 9.6, figure 9.24: how many rays?",
        "Tens of rays under an overcast sky, hundreds or thousands in scenes with concentrated light "
        "sources, hundreds of thousands with a sun.",
        ["chromeball probe rays PROBE --size 256x128"],
        "Random rays for a standard error of 10% on a surface that faces up:\n\n"
        + table(["probe", "uniform", "cosine", "luminance"], rows),
        "For uniform rays the first and the third statement hold, and the second but for St Peter's, "
        "which needs tens of thousands; rays in proportion to the cosine need fewer under an "
        "overcast sky; sampling by luminance needs few even with a sun.")]


def rows(run):
    return mappings(run) + suns(run) + clipping(run) + rays(run) + irradiance(run)

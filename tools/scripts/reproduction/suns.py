# SPDX-License-Identifier: Apache-2.0
"""Suns: HDRI's figures 9.14 to 9.17, and the numbers of section 9.6.1."""
import math

from gltf import Model
from page import Row, table
from pfm import read_pfm
from run import luminance

PAINT = 0.5


def model(run, name, add):
    made = Model()
    add(made)
    made.write(run.scratch / name)
    return run.scratch / name


def mean(run, image):
    pixels = [color for row in read_pfm(run.scratch / image) for color in row]
    return [sum(channel) / len(pixels) for channel in zip(*pixels)]


def floor(run):
    file = model(run, "floor.gltf", lambda m: m.quads("floor", m.material((1, 1, 1)),
                                                      [((-1, 0, 1), (2, 0, 0), (0, 0, -2))]))
    scene = run.scratch / "floor.toml"
    scene.write_text(f"""model = "{file}"
[camera]
position = [0, 3, 1]
look_at = [0, 0, 0]
fov = 5
[[light]]
direction = [0, 1, 0]
angle = 0.5323
radiance = 46700
""")
    run.render(scene, "floor.pfm", "--samples", 64, "--size", "8x8")
    radiance = mean(run, "floor.pfm")[0]
    exact = 46700 * math.sin(math.radians(0.5323 / 2)) ** 2
    return [Row(
        "HDRI 9.3.5: the radiance of the sun",
        "46,700 is chosen as the radiance of a sun of 0.53 degrees so that the brightest spot of a white sphere, which "
        "faces it, has radiance 1.",
        ["chromeball render floor.toml -o floor.pfm"],
        f"A white floor under a `[[light]]` with angle = 0.5323 and radiance = 46700: {radiance:.5f}, rendered; {exact:.5f} = 46,700 sin^2(0.5323 / 2 degrees), exact.",
        "The scene file of the text has 0.5323 degrees, for which the number is 0.8% too large; for 0.53 it is 0.1% too small.")]


def diffuse_ball(run):
    ball = model(run, "ball.gltf", lambda m: m.sphere("ball", m.material((PAINT,) * 3), (0, 0, 0), 1))
    distance, size = 10, 200
    fov = 2 * math.degrees(math.atan(1.1 / math.sqrt(distance ** 2 - 1)))
    scene = run.scratch / "ball.toml"
    rows = []
    for name, file in run.probes(["Qwantani", "Kloppenheim", "Hilly terrain"]).items():
        sun = run.json("probe", "info", file)["suns"][0]
        x, _, z = sun["direction"]  # the camera sees the ball from the side of the sun
        azimuth = math.atan2(x, z)
        scene.write_text(f"""model = "{ball}"
[camera]
position = [{distance * math.sin(azimuth)}, 0, {distance * math.cos(azimuth)}]
look_at = [0, 0, 0]
fov = {fov}
[probe]
file = "{file}"
""")
        run.render(scene, "ball.exr", "--samples", 256, "--size", f"{size}x{size}", "--max-depth", 1)
        run("probe", "edit", file, "clipped.exr", "--clip-stops", 4)
        radius = size / 2 / 1.1
        found = run.json("probe", "sun", "clipped.exr", "--diffuse", "ball.exr", "--circle",
                         f"{size / 2},{size / 2},{radius}", "--paint", ",".join([str(PAINT)] * 3), "--camera",
                         f"{math.degrees(azimuth)},0",
                         "--distance", distance)
        rows.append([name, f"{luminance(found['irradiance']):.3g}", f"{luminance(sun['irradiance']):.3g}",
                     f"{100 * found['rms']:.2g}", f"{100 * found['rms_clipped']:.3g}"])
    if not rows:
        return []
    return [Row(
        "HDRI figures 9.14 to 9.17: a clipped sun from a diffuse ball",
        "The sun's intensity is solved from a photograph of a grey ball; its render differs by less than 2%.",
        ["chromeball probe sun clipped.exr --diffuse ball.exr --circle X,Y,R --paint 0.5 --camera AZIMUTH,0 "
         "--distance 10"],
        table(["probe", "irradiance of the sun found", "of `probe info`", "RMS left, %",
               "RMS of the clipped probe alone, %"], rows),
        "The photographs are rendered here, and the probes clipped at 16 times their mean. `probe info` counts as sun "
        "only what stands out of its glow; the ball has all that was clipped.")]


def errata():
    facing = {d: 46700 * math.sin(math.radians(d / 2)) ** 2 for d in (0.53, 0.5323)}
    return [Row(
        "HDRI 9.3.5, 9.4 to 9.7: what to read with care",
        "Numbers and words that a program must decide about.", [],
        "- The colour 10,960,000 10,280,000 866,000 of a sun lacks a digit in blue: with 8,660,000 it is the yellowish "
        "one of the text.\n- Its direction, with y = -0.58, is where the light travels; (0.748, 0.199, 0.633) of 9.3.5 "
        "points to the sun. Here all directions point to the light.\n- The ideal mirror ball has \"forward\" in its "
        "middle; a photograph of a ball shows the camera there, and is mirrored: `probe convert --flip`.\n- 46,700 is "
        f"1 / sin^2(0.53 / 2 degrees) = {1 / math.sin(math.radians(0.265)) ** 2:,.0f}, rounded: the irradiance is "
        f"{facing[0.53]:.4f} pi for 0.53 degrees and {facing[0.5323]:.4f} pi for 0.5323.\n"
        "- 9.4.1: in the ball's mapping from image to world, theta = atan2(2u - 1, -2v + 1) has its arguments exchanged; "
        "with D_x = sin(phi) cos(theta) it is atan2(-2v + 1, 2u - 1), as 9.4.2 has it.\n- 9.4.2: in the angular map's "
        "mapping from world to image, (u, v) = (1/2 - r D_y, 1/2 + r D_x) has u and v exchanged; it is (1/2 + r D_x, "
        "1/2 - r D_y), as in 9.4.1.\n- 9.4.3, 9.6.2: texels are weighted by cos(phi) of the latitude, but the formulas "
        "of the mapping have phi = pi v from the pole, of which it is the sine.\n- 9.5: the estimate of irradiance, the "
        "mean of L cos(theta) over directions that are uniform on the hemisphere, lacks the factor 2 pi.\n- 9.5, 9.7: "
        "irradiance is multiplied by the albedo, and rho = L / E, without the 1 / pi of a Lambertian surface's radiance.\n- "
        "9.2.5, 9.6.2: the blur of the clipped image is called figure 9.6 (d), and the lights of a cube's faces 9.31 (a); "
        "the captions have (b) for both.\n- 9.7: "
        "the composite in which objects shadow the ground is called figure 9.38 (c); its caption has (c) for the white "
        "local scene without objects, and (e) for the composite.", "")]


def rows(run):
    return floor(run) + diffuse_ball(run) + errata()

# SPDX-License-Identifier: Apache-2.0
"""What the two films show: HDRI's figures 9.3, 9.4 and 9.30."""
from gallery import scene_of
from page import Row

SMALL = ["--samples", 128, "--denoise"]
MIX = ".75:0.5,.15:3,.07:12,.03:48"


def pedestal(run):
    image = run.render(scene_of(run, "rnl"), "rnl.exr", *SMALL, "--size", "240x240")
    run("image", "develop", image, run.pictures / "film-developed.png", "--bloom", MIX, "--vignette", 0.6)
    return Row(
        "HDRI figures 9.3 and 9.4: Rendering with Natural Light",
        "A pedestal with balls of glass, metal and plastic stands in a large box, onto whose walls the light probe of a "
        "grove is mapped; the frames are shown before and after blooming and vignetting.",
        ["build/make_demo rnl out/rnl.glb && chromeball render scenes/rnl.toml",
         f"chromeball image develop out/rnl.exr out/developed.png --bloom {MIX} --vignette 0.6"],
        "A pedestal of this project in a box of 24 x 14 x 24 metres with its dusk.",
        "The model and the probe are this project's own: the film's are not published for use.",
        [(run.picture(image, "film-rendered.png"), "As rendered"),
         ("film-developed.png", "With bloom and vignetting")])


def spinning(run):
    scene = scene_of(run, "five-shapes")
    common = [*SMALL, "--size", "240x150", "--animation-time", 0.3]
    still = run.render(scene, "still.exr", *common)
    moving = run.render(scene, "moving.exr", *common, "--fps", 24, "--shutter", 2)
    return Row(
        "HDRI figure 9.30: objects that spin, with motion blur",
        "A frame of Fiat Lux has the streaks that bright reflections draw on spinning objects: motion blur of high "
        "dynamic range.",
        ["chromeball render scenes/five-shapes.toml --animation-time 0.3 --fps 24 --shutter 2"],
        "Every sample has its own time, and so have its shadow rays and reflections. That the light of a moving "
        "highlight is that of a still one, and the image the mean of stills, are tests of the project.",
        "Other objects. The exposure is twice a frame's time, to be seen at this size.",
        [(run.picture(still, "film-still.png"), "An instant"), (run.picture(moving, "film-moving.png"), "Two frames' time")])


def rows(run):
    return [pedestal(run), spinning(run)]

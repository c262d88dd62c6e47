# SPDX-License-Identifier: Apache-2.0
"""Speed of this program and of another version of it, for the same images; see versus_commit.sh.

Both render in turn, a round for each seed, so that a change of the machine's speed affects both; the ratio is the
median over the rounds of the ratio of their times, with the smallest and the largest. Only rendering is timed: no
loading, no building of structures and tables. All pixels get the same number of samples, and nothing is guided.
Memory is the largest that the process has taken. "brighter" is the mean relative difference of the two images'
brightness over the rounds, with its standard deviation.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "versus"
OWN = ROOT / "build" / "chromeball"
DEMOS = ("lambertian", "conductors", "plastics", "glass", "room", "fine")


def arguments():
    parser = argparse.ArgumentParser(prog="versus_commit.sh COMMIT", description=__doc__.split("\n")[0])
    parser.add_argument("other", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--scenes", nargs="+", default=DEMOS, help="of make_demo, or models")
    parser.add_argument("--probe", type=pathlib.Path, default=ROOT / "probes" / "dusk.exr")
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--depths", type=int, nargs="+", default=[1, 5])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--options", default="", help="further options of render, for both")
    return parser.parse_args()


def render(program, image, model, depth, seed, options):
    """Returns the seconds of rendering and the bytes of memory."""
    stats = image.with_suffix(".json")
    process = subprocess.Popen(
        [program, "render", model, "--probe", options.probe, "--size", options.size, "--samples",
         str(options.samples), "--adaptive", "off", "--guide", "off", "--max-depth", str(depth), "--seed", str(seed),
         "--threads", str(options.threads), "--stats", stats, "--quiet", "-o", image, *options.options.split()],
        stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{program} failed on {model}")
    return json.loads(stats.read_text())["seconds"]["render"], 1024 * usage.ru_maxrss


def difference(image, other):
    """That of their brightness, relative."""
    done = subprocess.run([OWN, "image", "error", image, other, "--json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["bias"]


def model_of(scene):
    if scene not in DEMOS:
        return pathlib.Path(scene)
    model = WORK / f"{scene}.glb"
    subprocess.run([ROOT / "build" / "make_demo", scene, model], check=True)
    return model


def compare(scene, depth, options):
    model = model_of(scene)
    images = WORK / "versus-other.exr", WORK / "versus-own.exr"
    rounds, differences = [], []
    for seed in range(1, options.rounds + 1):
        rounds.append([render(program, image, model, depth, seed, options)
                       for program, image in zip((options.other, OWN), images)])
        differences.append(difference(*reversed(images)))
    ratios = [other[0] / own[0] for other, own in rounds]
    width, height = map(int, options.size.split("x"))
    seconds = statistics.median(own[0] for _, own in rounds)
    memory = statistics.median(own[1] / other[1] for other, own in rounds)
    spread = statistics.stdev(differences) / math.sqrt(len(rounds)) if len(rounds) > 1 else math.nan
    print(f"{model.stem:24}{depth:6}{seconds:10.2f}{width * height * options.samples / seconds / 1e6:12.2f}"
          f"{statistics.median(ratios):10.2f}  {min(ratios):.2f} to {max(ratios):.2f}{memory:9.2f}"
          f"{statistics.mean(differences):12.1e} +- {spread:.0e}",
          flush=True)


def main():
    options = arguments()
    WORK.mkdir(parents=True, exist_ok=True)
    print(f"{options.probe.name}, {options.size}, {options.samples} samples per pixel, {options.threads} threads, "
          f"{options.rounds} rounds {options.options}\n"
          f"{'scene':24}{'depth':>6}{'seconds':>10}{'Msamples/s':>12}{'faster':>10}  {'from, to':12}{'memory':>9}"
          f"{'brighter':>12}", flush=True)
    for scene in options.scenes:
        for depth in options.depths:
            compare(scene, depth, options)


main()

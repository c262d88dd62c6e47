# SPDX-License-Identifier: Apache-2.0
"""A data set of one model under several probes: images with layers, cameras and lights.

    python dataset.py [--folder data] [--model MODEL.glb] [--probes A.exr B.exr ...] [--shard 2/4] [--quick] ...

Each image is a .png, an .exr (radiance and all layers) and an .npz (depth, normals, albedo, masks, camera, suns), and has
a line in manifest.jsonl (manifest-2-of-4.jsonl of a shard). It depends on its number and the arguments alone, whatever
process renders it. Images that have a line are skipped: the same command goes on where it was interrupted.
"""

import argparse
import itertools
import json
import pathlib

import numpy as np

import chromeball as cb

PROJECT = pathlib.Path(__file__).resolve().parents[2]
LAYERS = ["depth", "normal", "albedo", "alpha", "node", "material"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=pathlib.Path, default="data")
    parser.add_argument("--model", default=PROJECT / "scenes" / "models" / "still-life.glb")
    parser.add_argument("--probes", nargs="+", default=[PROJECT / "probes" / "dusk.exr", PROJECT / "probes" / "noon.exr"])
    parser.add_argument("--turns", type=int, default=2, help="of each probe")
    parser.add_argument("--poses", type=int, default=5, help="for each turn")
    parser.add_argument("--target", type=float, nargs=3, default=(0, 0.4, 0), help="that cameras look at, metres")
    parser.add_argument("--distance", type=float, default=4, help="of cameras from it, metres")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0, help="of this process; 0: all")
    parser.add_argument("--shard", default="1/1", help="1/4: every fourth image, from the first on")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    if options.quick:
        options.turns, options.poses, options.size, options.samples = 1, 2, 32, 4
    options.folder.mkdir(parents=True, exist_ok=True)
    return options


class DataSet:
    def __init__(self, options):
        self.options = options
        self.scene = cb.load(options.model)  # read by the first render, and kept
        self.probes = {file: cb.Probe(file) for file in options.probes}
        self.views = list(itertools.product(options.probes, range(options.turns), range(options.poses)))

    def missing(self):
        """The numbers of images without a line in a manifest."""
        done = set()
        for manifest in self.options.folder.glob("manifest*.jsonl"):
            for line in manifest.read_text().splitlines():
                try:
                    done.add(json.loads(line)["image"])
                except json.JSONDecodeError:  # the process was killed as it wrote
                    pass
        return [number for number in range(len(self.views)) if number not in done]

    def manifest(self, name="manifest.jsonl"):
        """A manifest, to add lines to it."""
        file = open(self.options.folder / name, "a+")
        file.seek(0)
        if file.read()[-1:] not in ("", "\n"):
            file.write("\n")
        return file

    def make(self, number):
        """Renders an image, writes its files, and returns its line."""
        o, (probe_file, turn, _) = self.options, self.views[number]
        random = np.random.default_rng([o.seed, number])
        rotation = 360 * (turn + random.random()) / o.turns
        probe = self.probes[probe_file].rotated(rotation)
        pose = pose_around(np.array(o.target), o.distance, 360 * random.random(), random.uniform(10, 50))
        K = np.array([[1.4 * o.size, 0, o.size / 2], [0, 1.4 * o.size, o.size / 2], [0, 0, 1]])
        seed = int(random.integers(2**32))
        image = cb.render(self.scene, probe, cb.Camera.from_intrinsics(K, (o.size, o.size), pose), samples=o.samples,
                          denoise=True, layers=LAYERS, seed=seed, threads=o.threads)
        suns = probe.suns()
        files = [f"{number:06}.{kind}" for kind in ("png", "exr", "npz")]
        image.save(o.folder / files[0])
        image.save(o.folder / files[1])
        layers = image.layers
        np.savez_compressed(o.folder / files[2], K=K, camera_to_world=pose, sun_directions=suns.directions,
                            sun_irradiances=suns.irradiances, **{name: layers[name] for name in ("depth", "normal", "albedo")},
                            node=layers["node"].astype(np.uint16), material=layers["material"].astype(np.uint16))
        return json.dumps({
            "image": number, "files": files, "seed": seed, "samples": o.samples, "K": K.tolist(),
            "camera_to_world": pose.tolist(), "probe": str(probe_file), "rotation": rotation, "model": str(o.model),
            "suns": [{"direction": d.tolist(), "irradiance": e.tolist()} for d, e in zip(suns.directions, suns.irradiances)],
            "nodes": json.loads(image.metadata["manifest/node"]), "version": cb.__version__,
        }) + "\n"


def pose_around(target, distance, azimuth, elevation):
    """The pose [4,4] of a camera that looks at the target: -Z ahead, +Y up."""
    a, e = np.radians(azimuth), np.radians(elevation)
    back = np.array([np.cos(e) * np.sin(a), np.sin(e), np.cos(e) * np.cos(a)])
    right = np.array([np.cos(a), 0, -np.sin(a)])
    pose = np.eye(4)
    pose[:3] = np.stack([right, np.cross(back, right), back, target + distance * back], axis=1)
    return pose


def main():
    options = arguments()
    data = DataSet(options)
    shard, shards = map(int, options.shard.split("/"))
    numbers = [number for number in data.missing() if number % shards == shard - 1]
    name = "manifest.jsonl" if shards == 1 else f"manifest-{shard}-of-{shards}.jsonl"
    with data.manifest(name) as manifest:
        for number in numbers:
            manifest.write(data.make(number))
            manifest.flush()
    print(f"{len(numbers)} of {len(data.views)} images rendered into {options.folder}")


if __name__ == "__main__":
    main()

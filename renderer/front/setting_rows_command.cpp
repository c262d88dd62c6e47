// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

namespace chromeball {

std::vector<Setting> commandRows() {
  using enum SettingType;
  std::vector<Setting> rows;
  addRenderOnly(
      rows, Effect::Image,
      {
          {.option = "clamp",
           .argument = "RADIANCE",
           .type = Number,
           .range = kPositive,
           .absent = "no sample is clamped",
           .help = "Scales samples down whose largest channel exceeds this; biased."},
          {.option = "transparent",
           .type = Flag,
           .help = "Hides the probe from the camera, and writes alpha."},
          {.option = "shadow-catcher",
           .argument = "NODE,...",
           .type = Name,
           .absent = "a plain render",
           .help = "Renders all other nodes, and the shadows and light that they cast on these, as "
                   "an image with alpha to be laid over a photograph, with the layers objects, "
                   "alpha, difference and ratio of the .exr. `ground`: a level plane at the "
                   "model's lowest point, unless a node is called so; --ground=HEIGHT puts it "
                   "elsewhere. Else as [composite] with mode = \"shadow-catcher\", whose ground is "
                   "at height 0."},
          {.option = "two-pass",
           .type = Flag,
           .help = "Renders a composite as the difference of two renders: slow, the reference for "
                   "the single pass. Its noise makes mode `ratio` brighter: take samples until "
                   "that is low."},
          {.option = "crop",
           .argument = "X,Y,W,H",
           .type = Name,
           .absent = "the whole image",
           .help = "Renders a part of the image: column and row of its first pixel, width, height. "
                   "`chromeball merge` puts parts together."},
          {.option = "shard",
           .argument = "K/N",
           .type = Name,
           .absent = "all samples",
           .help = "Takes the K-th of N equal shares of each pixel's samples; `chromeball merge` "
                   "puts the N images together. The .exr has what it needs."},
          {.option = "orbit",
           .argument = "DEGREES",
           .type = Number,
           .range = {.min = -36000, .max = 36000},
           .absent = "no turn",
           .help = "Turns the camera around the model, counter-clockwise seen from above. With "
                   "--frames: by equal steps from frame to frame, as many as there are frames, so "
                   "that the last one ends a step before the whole turn."},
          {.option = "turntable",
           .argument = "DEGREES",
           .type = Number,
           .range = {.min = -36000, .max = 36000},
           .absent = "no turn",
           .help = "Turns the models, with their lamps, about the vertical through their centre, "
                   "counter-clockwise seen from above, under a light and before a camera that "
                   "stand still, also if they are the models'. With --frames as --orbit."},
          {.option = "orbit-step",
           .argument = "DEGREES",
           .type = Number,
           .range = {.min = -36000, .max = 36000},
           .absent = "0; with --frames that of --orbit",
           .help = "With --shutter: how far the camera turns around the model from this frame to "
                   "the next."},
      });
  rows.insert(
      rows.end(),
      {
          {.option = "allow-external",
           .type = Flag,
           .help = "Lets models name files outside their own folders."},
          {.option = "memory",
           .argument = "GB",
           .type = Number,
           .range = kPositive,
           .unit = "GB",
           .absent = "0.8 times what the machine and its limits allow",
           .help = "Refuses images and scenes that take more than this.",
           .effect = Effect::Run},
          {.option = "texture-memory",
           .argument = "GB",
           .type = Number,
           .range = kPositive,
           .unit = "GB",
           .absent = "all textures are in memory",
           .help = "Memory for textures; less than 0.0105 counts as that. If they need more, they "
                   "go to a temporary file in $TMPDIR, of which so much is kept in memory. It does "
                   "not change the image.",
           .effect = Effect::Run},
          {.option = "threads",
           .type = Integer,
           .range = {.min = 0, .max = 65536},
           .fallback = "0",
           .help = "Number of threads; 0 is one for each core. It does not change the image.",
           .effect = Effect::Run},
      });
  addRenderOnly(
      rows, Effect::Run,
      {
          {.option = "stats",
           .argument = "FILE.json",
           .type = Name,
           .absent = "none",
           .help = "Writes times, rays, noise and the job's settings to this file."},
          {.option = "noise-map",
           .argument = "FILE.png",
           .type = Name,
           .absent = "none",
           .help = "Writes a small picture of each pixel's relative error, after denoising: from "
                   "black, 0.1% or less, over violet, 1%, and orange, 10%, to pale yellow, 100%."},
          {.option = "frames",
           .argument = "A:B[:STEP]",
           .type = Name,
           .absent = "one image",
           .help = "Renders the frames A to B of an animation. The last row of # in the names of "
                   "files becomes a frame's number. A frame is left alone if all its files exist."},
          {.option = "frame",
           .type = Integer,
           .absent = "all",
           .help = "Renders only this one of the frames, for machines that share them."},
          {.option = "fps",
           .argument = "NUMBER",
           .type = Number,
           .range = {.min = 0.001, .max = 1e6},
           .fallback = "24",
           .help =
               "Frames per second: frame N shows the time N / fps. Also the unit of --shutter."},
          {.option = "overwrite",
           .type = Flag,
           .help = "Renders also the frames whose images exist."},
          {.option = "seed-per-frame",
           .type = Flag,
           .help = "Adds a frame's number to the seed. Without it the noise of all frames is "
                   "alike: it stays where nothing moves, and denoised frames flicker less."},
          {.option = "probe-sequence",
           .argument = "PROBE.####.exr",
           .type = Name,
           .absent = "one probe",
           .help = "With --frames: each frame's own probe; the last row of # becomes its number."},
          {.option = "write-every",
           .argument = "SECONDS",
           .type = Number,
           .range = kPositive,
           .unit = "seconds",
           .absent = "at the end",
           .help = "Writes the image so far again and again, with so many seconds between."},
          {.option = "preview",
           .argument = "PORT",
           .bare = "0",
           .type = Integer,
           .range = {.min = 0, .max = 65535},
           .absent = "none",
           .help = "Serves a page on this machine that shows the image while it grows. 0 or no "
                   "number: any free port."},
          {.option = "display",
           .argument = "tev[=HOST:PORT]",
           .type = Name,
           .absent = "none",
           .help = "Sends the image while it grows to the image viewer tev, at 127.0.0.1:14158 if "
                   "no address is given."},
          {.option = "cache",
           .argument = "FILE",
           .type = Name,
           .absent = "none",
           .help =
               "Keeps the records of --irradiance-cache for later views of the same scene: uses "
               "those of the file and writes it with those added. With --frames it may have a #."},
          {.option = "checkpoint",
           .argument = "FILE.exr",
           .type = Name,
           .absent = "none",
           .help = "Keeps what a render needs to go on after it was stopped or killed; also at its "
                   "end, for more samples."},
          {.option = "checkpoint-every",
           .argument = "SECONDS",
           .type = Number,
           .range = kPositive,
           .unit = "seconds",
           .fallback = "300",
           .help = "Time between checkpoints."},
          {.option = "resume",
           .type = Flag,
           .help = "Continues from the checkpoint, or starts where there is none. --time counts "
                   "the earlier runs."},
      });
  return rows;
}

}  // namespace chromeball

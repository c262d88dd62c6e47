// SPDX-License-Identifier: Apache-2.0
// What one render is to do: the command line laid over the scene file, laid over the defaults.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "image/tonemap.h"
#include "integrate/render.h"
#include "job/scene_file.h"

namespace chromeball {

// An option as the command line has it: its name without dashes, its arguments with commas between;
// "true" for a flag.
struct GivenOption {
  std::string name, text;
};

// The options of `chromeball render` as they were given.
struct RenderOptions {
  std::vector<GivenOption> given;  // every one that was, in the order of --help
  std::string scene;
  std::vector<std::string> outputs, aovs;
  std::optional<std::string> probe, mapping, strategy, mis, camera, size, animation, variant;
  std::optional<std::string> singleSided, lights, lightUnits;
  std::optional<float> rotation, scale, clamp;
  std::optional<int64_t> samples, maxDepth, maxTransmissionDepth;
  std::optional<double> time, noise, animationTime, memory;
  std::optional<uint64_t> seed;
  int threads = 0;
  std::string stats;
  bool progress = false, quiet = false, transparent = false, twoPass = false;
  bool allowExternal = false;
  std::string tonemap = "none";
  float exposure = 0;
};

struct RenderJob {
  SceneFile file;           // models, camera, probe
  RenderSettings settings;  // but for the size, which the camera may decide
  std::optional<SceneFile::Size> size;
  SingleSided singleSided = SingleSided::Camera;
  std::optional<double> memory;  // the most the picture may take, in bytes
  NamedSetting strategy;
  std::vector<std::string> outputs;
  DisplayTransform display;
};

// Throws InputError for whatever the options or the scene file get wrong, before any work is done.
// Leaves the outputs out.
RenderJob planJob(const RenderOptions& options);

// Where the pictures go. Throws InputError where there is no such place.
void planOutputs(RenderJob& job, const RenderOptions& options);

// To be called when all files are read (`inputs`, the scene itself aside) and nothing else can be
// wrong: throws InputError where one of them would be overwritten, and makes the folders that the
// scene file names for its pictures.
void prepareOutputs(const RenderJob& job, const RenderOptions& options,
                    std::vector<std::string> inputs);

}  // namespace chromeball

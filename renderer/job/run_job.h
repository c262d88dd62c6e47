// SPDX-License-Identifier: Apache-2.0
// Renders a job whose scene is loaded: the one place that builds the acceleration structure and the
// lighting, and calls the integrators.
#pragma once

#include <atomic>

#include "base/message.h"
#include "base/progress.h"
#include "image/io/write_image.h"
#include "integrate/render.h"
#include "integrate/world.h"
#include "job/image_noise.h"
#include "job/load_scene.h"
#include "job/render_job.h"

namespace chromeball {

// What a render needs beside the scene. The scene must outlive it.
struct PreparedScene {
  std::unique_ptr<const World> world;
  std::unique_ptr<LightingStrategy> lighting;
  double buildSeconds = 0, prepareSeconds = 0;  // of the world, of the lighting
};

// Throws InputError for a strategy that is unknown or does not suit the probe.
PreparedScene prepareScene(const RenderJob& job, const LoadedScene& loaded);

// How a composite came out.
struct CompositeReport {
  double coverage = 0;           // mean alpha of the objects
  size_t darkerThanBlack = 0;    // pixels where the difference exceeds the plate; they became black
  struct Reflectance {           // of the local scene, found from the plate
    size_t pixels = 0;           // that see the local scene
    double clampedFraction = 0;  // of them: need an albedo above 1
    double exposureRatio = 0;    // plate over the local scene with the model's own reflectance
    double lastChange = 0;       // mean |change| of the reflectance in the last iteration
  };
  std::optional<Reflectance> reflectance;
};

struct JobResult {
  OutputImage image;  // the color first, then the job's layers; no metadata
  RenderResult render;
  ImageNoise noise;  // of the color
  std::optional<CompositeReport> composite;
  Messages messages;
  double seconds = 0;  // of rendering

  const Image& color() const { return image.layers.front().image; }  // linear RGB or RGBA
};

// Renders until the job's samples, time or noise is reached, or `stop` is set: then
// render.interrupted is true, and the image holds the samples so far.
JobResult renderJob(const RenderJob& job, const LoadedScene& loaded, const PreparedScene& prepared,
                    const Progress& progress, const std::atomic<bool>& stop);

// The same to the end, without progress.
JobResult renderJob(const RenderJob& job, const LoadedScene& loaded);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Renders a job with a loaded scene: builds the acceleration structure and the lighting strategy,
// and calls the integrators.
#pragma once

#include <atomic>

#include "base/message.h"
#include "base/progress.h"
#include "image/io/write_image.h"
#include "integrate/render.h"
#include "integrate/world.h"
#include "job/denoised_image.h"
#include "job/image_noise.h"
#include "job/load_scene.h"
#include "job/render_job.h"

namespace chromeball {

// The data that a render needs besides the scene, which must outlive it.
struct PreparedScene {
  std::unique_ptr<const World> world;
  std::unique_ptr<LightingStrategy> lighting;
  double buildSeconds = 0, prepareSeconds = 0;  // of the world, of the lighting
};

// Throws InputError for a strategy that is unknown or does not suit the probe.
PreparedScene prepareScene(const RenderJob& job, const LoadedScene& loaded);

// Statistics of a composite.
struct CompositeReport {
  double coverage = 0;           // mean alpha of the objects
  size_t darkerThanBlack = 0;    // number of pixels with negative results, which are set to 0
  struct Reflectance {           // of the local scene, estimated from the plate (reflectance.h)
    size_t pixels = 0;           // number of pixels that see the local scene
    double clampedFraction = 0;  // fraction of these that need an albedo above 1
    double exposureRatio = 0;    // plate over the local scene with the model's own reflectance
    double lastChange = 0;       // mean |change| of the reflectance in the last iteration
  };
  std::optional<Reflectance> reflectance;
};

struct JobResult {
  OutputImage image;  // the color first, then the job's layers; no metadata
  RenderResult render;
  ImageNoise noise;  // of the color, before denoising
  std::optional<CompositeReport> composite;
  std::optional<DenoiseReport> denoised;
  Messages messages;
  double seconds = 0;  // of rendering

  const Image& color() const { return image.layers.front().image; }  // linear RGB or RGBA
};

// Renders until the job's limit of samples, time or noise is reached, or `stop` is set. In the
// latter case render.interrupted is true, and the image contains the samples so far.
JobResult renderJob(const RenderJob& job, const LoadedScene& loaded, const PreparedScene& prepared,
                    const Progress& progress, const std::atomic<bool>& stop);

// The same without progress reports and interruption.
JobResult renderJob(const RenderJob& job, const LoadedScene& loaded);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The one render loop: every pixel's samples, in blocks, on all threads.
#pragma once

#include <atomic>
#include <optional>

#include "base/progress.h"
#include "film/aov.h"
#include "film/film.h"
#include "integrate/integrator.h"
#include "scene/camera.h"

namespace chromeball {

struct RenderSettings {
  int width = 800, height = 600;
  uint32_t samples = 256;            // per pixel, >= 1; the most where a limit below is set
  std::optional<double> timeLimit;   // seconds
  std::optional<double> noiseLimit;  // fraction (film.h)
  int maxDepth = 8;
  int maxTransmissionDepth =
      kUsualTransmissionDepth;  // bounces in bodies of glass, beside maxDepth
  Mis mis = Mis::Balance;
  uint64_t seed = 0;
  bool hideProbe = false;      // from the camera only: for compositing
  std::optional<float> clamp;  // the largest channel a sample may have; else none is clamped
  std::vector<Aov> aovs;
};

struct RenderResult {
  Film film;
  AovFilm aovs;
  RayCounts rays;
  InvalidSamples invalid;
  ClampedSamples clamped;
  uint32_t samples = 0;  // that every pixel has; 0 where a render was stopped before its first pass
  bool interrupted = false;
};

// Renders until the samples, the time or the noise is reached, or `stop` is set. Passes over the
// whole picture begin with a few samples and double, so that a picture of the whole is there soon.
// The result depends on the settings alone, not on the number of threads (but for the time limit).
RenderResult render(const Scene& scene, const Accel& accel, const Camera& camera,
                    const LightingStrategy& lighting, const RenderSettings& settings,
                    const Progress& progress, const std::atomic<bool>& stop);

// The same for what another integrator estimates. The camera's rays are traced through `accel`.
RenderResult render(const Integrator& integrator, const Accel& accel, const Camera& camera,
                    const RenderSettings& settings, const Progress& progress,
                    const std::atomic<bool>& stop);

}  // namespace chromeball

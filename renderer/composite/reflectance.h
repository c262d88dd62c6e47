// SPDX-License-Identifier: Apache-2.0
// Estimates the reflectance of the local scene from the plate (HDRI book, section 9.7).
#pragma once

#include "composite/differential.h"
#include "render/render.h"
#include "scene/camera.h"

namespace chromeball {

struct ReflectanceSolution {
  size_t pixels = 0;   // number of pixels that see the local scene
  size_t clamped = 0;  // number of pixels that need an albedo above 1
  // Mean luminance of the plate / mean luminance of the local scene rendered with the model's
  // albedo; 0 if the latter is black.
  double exposureRatio = 0;
  double lastChange = 0;  // mean |change| of the reflectance in the last iteration
};

// The plate, and the scene and light that it shows.
struct ReflectanceProblem {
  const World&
      world;  // after makeProjected() (local_scene.h); masks as in composite/differential.h
  const Camera& camera;
  const LightSource& lighting;
  const Image& plate;
};

// Fills `projection` with the reflectance for which the render of the local scene equals the plate:
//   rho = (plate - L(0)) / (L(1) - L(0)), which is pi plate / E without emission or highlights.
// L(rho) is the radiance of the visible surface with base colour rho, lit by the probe and by
// surfaces with the reflectance of the previous iteration (initially 0.25). Clamped to [0, 1]; the
// model's base colour where no light arrives. A convex local scene needs one iteration.
ReflectanceSolution solveReflectance(const ReflectanceProblem& problem,
                                     const RenderSettings& settings, int iterations,
                                     Projection& projection, const Progress& progress,
                                     const std::atomic<bool>& stop);

// The same for a flat local scene under a distant probe, whose constant irradiance is `irradiance`
// (probe/irradiance.h); no light transport is simulated.
ReflectanceSolution solveFlatReflectance(const ReflectanceProblem& problem,
                                         const RenderSettings& settings, const Rgb& irradiance,
                                         Projection& projection, const std::atomic<bool>& stop);

}  // namespace chromeball

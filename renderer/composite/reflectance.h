// SPDX-License-Identifier: Apache-2.0
// What the local scene reflects, found from the plate (HDRI book, 9.7).
#pragma once

#include "composite/differential_path.h"
#include "integrate/render.h"
#include "scene/projection.h"

namespace chromeball {

struct ReflectanceSolution {
  size_t pixels = 0;         // that see the local scene
  size_t clamped = 0;        // of them, those that would have to reflect more than all light
  double exposureRatio = 0;  // plate over the local scene as the model has it; 0: that is black
  double lastChange = 0;     // mean |change| of the reflectance in the last iteration
};

// Gives each instance of the local scene a material of its own: matte, its base colour that of
// `projection` where the camera sees it and the model's elsewhere. The projection must outlive the
// scene's use; it is told what the camera sees by solveReflectance().
void makeProjected(Scene& scene, const ObjectMask& isObject, const Projection& projection);

// Adds to the local scene a dielectric's specular lobe (9.7.2): `strength` times that of index of
// refraction 1.5, `roughness` as in glTF.
void makeGlossy(Scene& scene, const ObjectMask& isObject, float strength, float roughness);

// What light the plate is explained by.
struct ReflectanceProblem {
  const Scene& scene;  // its local scene projected
  const ObjectMask& isObject;
  const Camera& camera;
  const LightingStrategy& lighting;
  const Image& plate;
};

// Fills `projection` with reflectances that make the local scene look like the plate:
//   rho = (plate - L(0)) / (L(1) - L(0)), which is pi plate / E where nothing shines or glitters,
// L(rho) being the radiance of a surface with base colour rho among others as they are known so
// far, 0.25 at first. Clamped to [0, 1]; the model's where no light falls. A convex local scene
// needs one iteration.
ReflectanceSolution solveReflectance(const ReflectanceProblem& problem,
                                     const RenderSettings& settings, int iterations,
                                     Projection& projection, const Progress& progress,
                                     const std::atomic<bool>& stop);

// The same for a flat local scene under a distant probe, whose irradiance is everywhere
// `irradiance` (probe/irradiance.h): no light is rendered.
ReflectanceSolution solveFlatReflectance(const ReflectanceProblem& problem,
                                         const RenderSettings& settings, const Rgb& irradiance,
                                         Projection& projection, const std::atomic<bool>& stop);

// The unit normal that all of the local scene has, upwards; nullopt where it is not flat.
std::optional<vec3> flatNormal(const Scene& scene, const ObjectMask& isObject);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// The reflectance of the local scene, estimated from the plate (HDRI book, 9.7).
#pragma once

#include "composite/objects.h"
#include "integrate/render.h"
#include "scene/projection.h"

namespace chromeball {

struct ReflectanceSolution {
  size_t pixels = 0;         // that see the local scene
  size_t clamped = 0;        // of these, those that need an albedo above 1
  double exposureRatio = 0;  // plate over the local scene with the model's albedo; 0: that is black
  double lastChange = 0;     // mean |change| of the reflectance in the last iteration
};

// Gives each instance of the local scene a matte material of its own, with the base colour of
// `projection` where the camera sees it and the model's elsewhere. The projection must outlive the
// scene; solveReflectance() fills it.
void makeProjected(Scene& scene, const ObjectMask& isObject, const Projection& projection);

// Adds to the local scene a dielectric's specular lobe (9.7.2): `strength` times that of index of
// refraction 1.5, `roughness` as in glTF.
void makeGlossy(Scene& scene, const ObjectMask& isObject, float strength, float roughness);

// The plate and the scene that explains it.
struct ReflectanceProblem {
  const World& world;  // its local scene projected; masks as in composite/objects.h
  const Camera& camera;
  const LightingStrategy& lighting;
  const Image& plate;
};

// Fills `projection` with reflectances that make the local scene look like the plate:
//   rho = (plate - L(0)) / (L(1) - L(0)), which is pi plate / E without emission or highlights,
// with L(rho) the radiance of a surface of base colour rho among others of the reflectance found
// so far, 0.25 at first. Clamped to [0, 1]; the model's base colour where no light arrives. A
// convex local scene needs one iteration.
ReflectanceSolution solveReflectance(const ReflectanceProblem& problem,
                                     const RenderSettings& settings, int iterations,
                                     Projection& projection, const Progress& progress,
                                     const std::atomic<bool>& stop);

// The same for a flat local scene under a distant probe, where irradiance is `irradiance`
// everywhere (probe/irradiance.h): no light transport is simulated.
ReflectanceSolution solveFlatReflectance(const ReflectanceProblem& problem,
                                         const RenderSettings& settings, const Rgb& irradiance,
                                         Projection& projection, const std::atomic<bool>& stop);

// The unit normal of a flat local scene, upwards; nullopt where it is not flat.
std::optional<vec3> flatNormal(const Scene& scene, const ObjectMask& isObject);

}  // namespace chromeball

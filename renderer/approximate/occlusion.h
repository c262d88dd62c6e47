// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion: which part of the sky a surface sees (HDRI book, section 9.8.2).
#pragma once

#include <cmath>

#include "math/vec.h"
#include "trace/ray.h"

namespace chromeball {

struct PathContext;
struct Surface;
struct World;

// Which light of the probe geometry blocks.
struct Occlusion {
  bool ambient = false;       // diffuse
  bool reflection = false;    // specular and transmitted
  float distance = INFINITY;  // of what blocks diffuse light, metres
  bool uniformBent = false;   // bent normals are unweighted means (HDRI book, section 9.8.2)
};

// One direction of the hemisphere above a surface, and how much light passes there.
struct SkyRay {
  vec3 direction;
  Rgb transmittance;
};

// Of density cos / pi around `normal`; nothing passes below the geometry. A ray that is not blocked
// within `distance` metres sees the sky. Uses the random numbers of light samples.
SkyRay cosineSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                    RayMask visible, PathContext& context);

// Of constant density over the hemisphere.
SkyRay uniformSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                     RayMask visible, PathContext& context);

}  // namespace chromeball

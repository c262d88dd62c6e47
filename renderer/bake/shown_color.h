// SPDX-License-Identifier: Apache-2.0
// What viewers without light show of baked light.
#pragma once

#include "bake/point_light.h"

namespace chromeball {

// Linear RGB and coverage at a point whose front has this light: for irradiance E, base colour x
// E / pi plus what the surface emits along its normal; for radiance the light itself; for occlusion
// its grey. The base colour is the mean over the point's extent.
vec4 shownColor(const PointLight& light, const BakePoint& point, const Rgb& baked);

// Whether the colours of an instance count for the scale of the file: those of surfaces that emit
// do not, so that lamps do not darken the rest.
bool countsForScale(const Scene& scene, int instance);

// The smallest power of two, from 1 up, that no channel exceeds.
float scaleOf(float maximum);

}  // namespace chromeball

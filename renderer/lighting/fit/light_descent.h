// SPDX-License-Identifier: Apache-2.0
// Directional lights moved to where they best reproduce a probe's irradiance.
#pragma once

#include <vector>

#include "lighting/fit/radiance_points.h"
#include "probe/mapping.h"

namespace chromeball {

// Lights whose irradiance is to be like a probe's on surfaces of every orientation.
struct FittedLights {
  std::vector<dvec3> directions;   // unit
  std::vector<dvec3> irradiances;  // RGB, not negative; one for each direction
  dvec3 ambient{0};                // radiance from everywhere
  // The integral over all normals, summed over RGB, of (E_lights - E_probe)^2 / 2, but for the term
  // that depends on the probe alone.
  double misfit = 0;
};

// The best colours for these directions (and the best ambient radiance, where it is asked for),
// sought from those that `lights` has.
void solveColors(FittedLights& lights, const RadiancePoints& probe, bool ambient);

// The derivatives of the misfit when directions move along the tangents of tangentsOf, two for each
// light, with colours as they are.
std::vector<double> misfitGradient(const FittedLights& lights, const RadiancePoints& probe);

struct Tangents {
  dvec3 s, u;  // unit, perpendicular to each other and to the direction
};
Tangents tangentsOf(const dvec3& direction);

// Moves the directions by Levenberg and Marquardt's method, the colours always being the best for
// them (variable projection: Golub and Pereyra 1973; Kaufman's approximation 1975). Never raises
// the misfit. Stops after `maxSteps`, or where a step gains next to nothing.
void descend(FittedLights& lights, const RadiancePoints& probe, bool ambient, int maxSteps);

}  // namespace chromeball

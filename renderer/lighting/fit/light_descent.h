// SPDX-License-Identifier: Apache-2.0
// Optimises directional lights: the colours for given directions, and the directions by descent.
#pragma once

#include <vector>

#include "lighting/fit/radiance_points.h"
#include "probe/mapping.h"

namespace chromeball {

// Lights fitted to a probe's irradiance over all surface orientations.
struct FittedLights {
  std::vector<dvec3> directions;   // unit
  std::vector<dvec3> irradiances;  // RGB, not negative; one for each direction
  dvec3 ambient{0};                // radiance from all directions
  // The integral over all normals, summed over RGB, of (E_lights - E_probe)^2 / 2, without the term
  // that depends on the probe alone.
  double misfit = 0;
};

// Sets the optimal colours for the directions (and the optimal ambient radiance, if `ambient`). The
// current ones are the starting point.
void solveColors(FittedLights& lights, const RadiancePoints& probe, bool ambient);

// The derivatives of the misfit along the tangents of tangentsOf(), two per light, with constant
// colours.
std::vector<double> misfitGradient(const FittedLights& lights, const RadiancePoints& probe);

struct Tangents {
  dvec3 s, u;  // unit, perpendicular to each other and to the direction
};
Tangents tangentsOf(const dvec3& direction);

// Moves the directions by the Levenberg-Marquardt method with the colours always optimal (variable
// projection: Golub and Pereyra 1973; Kaufman's approximation 1975). Never increases the misfit.
// Stops after `maxSteps`, or when a step gains almost nothing.
void descend(FittedLights& lights, const RadiancePoints& probe, bool ambient, int maxSteps);

}  // namespace chromeball

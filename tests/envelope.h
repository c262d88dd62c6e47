// SPDX-License-Identifier: Apache-2.0
// Helpers for the tests that tests/ENVELOPE.md lists.
#pragma once

#include "test_scene.h"

namespace chromeball {

Scene plane(const Material& material, float half = 10);

// Mean luminance of a render; expects that it has no invalid samples.
double validMean(const RenderResult& result);

// Irradiance / pi of a plane with `normal`, by quadrature over theta and phi.
double irradianceOverPi(const Probe& probe, const vec3& normal, int rows);

}  // namespace chromeball

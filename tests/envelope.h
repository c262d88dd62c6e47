// SPDX-License-Identifier: Apache-2.0
// Helpers for the tests that tests/ENVELOPE.md lists.
#pragma once

#include <gtest/gtest.h>

#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball {

inline Scene plane(const Material& material, float half = 10) {
  Scene scene;
  addQuad(scene, addMaterial(scene, material), {-half, 0, half}, {2 * half, 0, 0},
          {0, 0, -2 * half});
  return scene;
}

// Mean luminance of a render; expects that it has no invalid samples.
inline double validMean(const RenderResult& result) {
  EXPECT_EQ(result.invalid.total(), 0u);
  return luminance(glm::dvec3(meanColor(result.film.mean())));
}

// Irradiance / pi of a plane with `normal`, by quadrature over theta and phi.
inline double irradianceOverPi(const Probe& probe, const vec3& normal, int rows) {
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 2 * rows; ++j) {
      const double theta = kPiD * (i + 0.5) / rows, phi = kPiD * (j + 0.5) / rows;
      const vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta),
                   std::sin(theta) * std::cos(phi));
      sum += double(luminance(probe.radiance(d))) * std::max(0.0f, glm::dot(d, normal)) *
             std::sin(theta);
    }
  return sum * (kPiD / rows) * (kPiD / rows) / kPiD;
}

}  // namespace chromeball

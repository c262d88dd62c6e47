// SPDX-License-Identifier: Apache-2.0
#include "envelope.h"

#include <gtest/gtest.h>

namespace chromeball {

Scene plane(const Material& material, float half) {
  Scene scene;
  addQuad(scene, addMaterial(scene, material), {-half, 0, half}, {2 * half, 0, 0},
          {0, 0, -2 * half});
  return scene;
}

double validMean(const RenderResult& result) {
  EXPECT_EQ(result.invalid.total(), 0u);
  return luminance(glm::dvec3(meanColor(result.film.mean())));
}

double irradianceOverPi(const Probe& probe, const vec3& normal, int rows) {
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

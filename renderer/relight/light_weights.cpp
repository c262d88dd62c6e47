// SPDX-License-Identifier: Apache-2.0
#include "relight/light_weights.h"

#include "relight/sphere_sum.h"

namespace chromeball {

std::vector<Rgb> lightWeights(const DirectionBasis& basis, const Image& latLong,
                              const Rotation& rotation, int leastWidth) {
  const Probe probe(latLong);
  const auto fine = [](int texels, int least) { return texels * ((least + texels - 1) / texels); };
  // The harmonics are smooth, and a search for the nearest direction is slow.
  if (!basis.hasCells() || basis.kind() == DirectionBasis::Nearest)
    leastWidth = std::min(leastWidth, 1024);
  const ImageSize grid{fine(latLong.width, leastWidth), fine(latLong.height, leastWidth / 2)};
  const auto count = size_t(basis.size());
  const auto sums = sumOverSphere<glm::dvec4>(
      grid, count, [&](const dvec3& d, double solidAngle, std::vector<glm::dvec4>& elements) {
        const glm::dvec4 light(dvec3(probe.radiance(vec3(d))), 1);
        basis.forValues(vec3(rotation(d)), [&](int element, float value) {
          elements[size_t(element)] += solidAngle * double(value) * light;
        });
      });
  std::vector<Rgb> weights(count, Rgb(0));
  for (size_t i = 0; i < count; ++i) {
    if (!basis.hasCells()) weights[i] = Rgb(sums[i]);
    // A cell that is smaller than the grid's texels may have none.
    else if (sums[i].w > 0)
      weights[i] = Rgb(dvec3(sums[i]) / sums[i].w);
  }
  return weights;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "composite/differential.h"

namespace chromeball {

Sample DifferentialIntegrator::sample(const CameraSample& camera, PathMemory& memory,
                                      FirstHit* first) const {
  const DifferentialSample s = differentialRadiance(scene_, camera, memory, first);
  const Rgb withObjects = s.both + s.withObjects, without = s.both + s.without;
  memory.rays.depthCut.addFound(withObjects);
  for (const Rgb& radiance : {withObjects, without})
    if (const auto defect = defectOf(radiance, false)) return {radiance, defect};

  DifferentialPixel& pixel = film_.at(camera.x, camera.y);
  ++pixel.count;
  if (s.objectFirst) {
    ++pixel.covered;
    const Rgb seen = memory.clamp(withObjects);
    pixel.objects += glm::dvec3(seen);
    pixel.behind += glm::dvec3(without);
    return seen;
  }
  const Rgb difference = memory.clamp(s.difference());
  pixel.local += glm::dvec3(without);
  pixel.difference += glm::dvec3(difference);
  return {plate_.rgb(camera.x, camera.y) + difference, std::nullopt};
}

}  // namespace chromeball

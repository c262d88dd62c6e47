// SPDX-License-Identifier: Apache-2.0
#include "lighting/fit/light_error.h"

#include <limits>

namespace chromeball {

std::vector<dvec3> irradianceOf(const Constellation& lights, const Rgb& ambient,
                                std::span<const vec3> normals) {
  std::vector<dvec3> irradiance(normals.size(), kPiD * dvec3(ambient));
  for (const DirectionalLight& light : lights)
    for (size_t i = 0; i < normals.size(); ++i)
      irradiance[i] +=
          double(std::fmax(0.0f, dot(normals[i], light.direction))) * dvec3(light.irradiance);
  return irradiance;
}

LightError lightError(std::span<const dvec3> lights, std::span<const dvec3> probe) {
  dvec3 sum(0), max(0), probeSum(0);
  for (size_t i = 0; i < probe.size(); ++i) {
    const dvec3 difference = abs(lights[i] - probe[i]);
    sum += difference;
    max = glm::max(max, difference);
    probeSum += probe[i];
  }
  const auto overRgb = [](const dvec3& v) { return (v.x + v.y + v.z) / 3; };
  const double count = double(probe.size()), mean = overRgb(probeSum) / count;
  const auto percent = [&](double difference) {
    if (mean > 0) return 100 * difference / mean;
    return difference > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  return {percent(overRgb(sum) / count), percent(overRgb(max))};
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "measure/estimate_error.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

// acos loses half of the digits of small angles.
double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

}  // namespace

EstimateError estimateError(const Image& predicted, const Image& truth, const Image& mask) {
  double pp = 0, pt = 0, tt = 0, difference = 0, angles = 0;
  size_t pixels = 0, colored = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (*mask.at(x, y) == 0) continue;
      const glm::dvec3 p(predicted.rgb(x, y)), t(truth.rgb(x, y));
      ++pixels;
      pp += glm::dot(p, p);
      pt += glm::dot(p, t);
      tt += glm::dot(t, t);
      difference += glm::dot(p - t, p - t);
      if (p == glm::dvec3(0) || t == glm::dvec3(0)) continue;
      ++colored;
      angles += degreesBetween(p, t);
    }
  const double count = 3 * double(pixels);
  EstimateError error;
  error.rmse = std::sqrt(difference / count);
  error.scale = pp > 0 ? pt / pp : 0;
  // sum (scale p - t)^2 = sum t^2 - scale sum p t
  error.scaleInvariantRmse = std::sqrt(std::max(0.0, tt - error.scale * pt) / count);
  error.angularError = colored ? angles / double(colored) : std::nan("");
  return error;
}

}  // namespace chromeball

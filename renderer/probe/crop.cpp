// SPDX-License-Identifier: Apache-2.0
#include "probe/crop.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "probe/probe.h"

namespace chromeball {

using glm::dvec3;

double PinholeView::pixelAngle() const { return 2 * std::tan(glm::radians(fov) / 2) / size.height; }

dvec3 PinholeView::direction(double x, double y) const {
  const double pixel = pixelAngle();
  return pose(
      glm::normalize(dvec3((x - 0.5 * size.width) * pixel, (0.5 * size.height - y) * pixel, -1)));
}

Image crop(const Image& latLong, const PinholeView& view) {
  const Probe probe(latLong);
  // Two samples per texel between two directions.
  const auto samplesBetween = [&](const dvec3& a, const dvec3& b) {
    const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    return std::max(2, int(std::ceil(2 * angle * latLong.height / kPiD)));
  };
  Image out(view.size.width, view.size.height, 3);
  parallelFor(0, out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      const int columns =
                    samplesBetween(view.direction(x, y + 0.5), view.direction(x + 1, y + 0.5)),
                rows = samplesBetween(view.direction(x + 0.5, y), view.direction(x + 0.5, y + 1));
      dvec3 sum(0);
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
          sum += dvec3(
              probe.radiance(vec3(view.direction(x + (i + 0.5) / columns, y + (j + 0.5) / rows))));
      out.setRgb(x, y, Rgb(sum / (double(columns) * rows)));
    }
  });
  return out;
}

int rowsOfCrop(const Image& latLong, double fov) {
  const double rows = 2 * std::tan(glm::radians(fov) / 2) * latLong.height / kPiD;
  return int(std::lround(std::clamp(rows, 1.0, 1e6)));
}

}  // namespace chromeball

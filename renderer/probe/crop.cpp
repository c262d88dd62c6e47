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
  // Two samples per texel along the side of a pixel.
  const int n = std::max(2, int(std::ceil(2 * view.pixelAngle() * latLong.height / kPiD)));
  Image out(view.size.width, view.size.height, 3);
  parallelFor(0, out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      dvec3 sum(0);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          sum += dvec3(probe.radiance(vec3(view.direction(x + (i + 0.5) / n, y + (j + 0.5) / n))));
      out.setRgb(x, y, Rgb(sum / double(n * n)));
    }
  });
  return out;
}

int rowsOfCrop(const Image& latLong, double fov) {
  const double rows = 2 * std::tan(glm::radians(fov) / 2) * latLong.height / kPiD;
  return int(std::lround(std::clamp(rows, 1.0, 1e6)));
}

}  // namespace chromeball

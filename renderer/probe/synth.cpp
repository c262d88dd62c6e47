// SPDX-License-Identifier: Apache-2.0
#include "probe/synth.h"

#include <array>
#include <cmath>

#include "probe/convert.h"

namespace chromeball {
namespace {

constexpr int kSamplesPerSide = 8;  // anti-aliases edges

// A panel that faces the origin from distance 1.
struct SoftBox {
  dvec3 centre, right, up;
  double halfWidth, halfHeight;
  dvec3 radiance;

  // Azimuth in degrees, counter-clockwise from -Z seen from above; elevation in degrees.
  SoftBox(double azimuth, double elevation, double width, double height, const dvec3& light)
      : centre(directionAt(azimuth, elevation)),
        halfWidth(0.5 * width),
        halfHeight(0.5 * height),
        radiance(light) {
    const double a = azimuth * kPiD / 180;
    right = {std::cos(a), 0, -std::sin(a)};
    up = glm::cross(right, centre);
  }

  bool isSeenAlong(const dvec3& d) const {
    const double depth = glm::dot(d, centre);
    return depth > 0 && std::fabs(glm::dot(d, right)) < depth * halfWidth &&
           std::fabs(glm::dot(d, up)) < depth * halfHeight;
  }
};

}  // namespace

Image constantProbe(const ImageSize& size, const Rgb& radiance) {
  Image image(size.width, size.height, 3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) image.setRgb(x, y, radiance);
  return image;
}

Image oneHotProbe(const ImageSize& size, int x, int y, const Rgb& radiance) {
  Image image(size.width, size.height, 3);
  image.setRgb(x, y, radiance);
  return image;
}

Image gradientProbe(const ImageSize& size, const Rgb& radiance, const dvec3& slope) {
  return rasterize(Mapping::LatLong, size, 1,
                   [&](const dvec3& d) { return dvec3(radiance) * (1 + glm::dot(slope, d)); });
}

Image overcastProbe(const ImageSize& size, const Rgb& zenith, double groundAlbedo) {
  const dvec3 ground = dvec3(zenith) * (groundAlbedo * 7 / 9);  // albedo E / pi
  return rasterize(Mapping::LatLong, size, kSamplesPerSide, [&](const dvec3& d) {
    return d.y < 0 ? ground : dvec3(zenith) * ((1 + 2 * d.y) / 3);
  });
}

Image studioProbe(const ImageSize& size) {
  const std::array boxes = {
      SoftBox(-50, 35, 0.7, 0.7, dvec3(30, 29, 27)), SoftBox(60, 20, 0.8, 1.0, dvec3(7.2, 7.6, 8)),
      SoftBox(165, 30, 0.25, 1.1, dvec3(15)), SoftBox(0, 85, 1.2, 0.8, dvec3(10))};
  return rasterize(Mapping::LatLong, size, kSamplesPerSide, [&](const dvec3& d) {
    for (const SoftBox& box : boxes)
      if (box.isSeenAlong(d)) return box.radiance;
    return dvec3(0.02);
  });
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

// The solid angle of the rectangle from (0, 0) to (x, y) in a plane at distance 1.
double cornerSolidAngle(double x, double y) {
  return std::atan2(x * y, std::sqrt(1 + x * x + y * y));
}

// The solid angle of a texel of a cube's face with `side` texels.
double faceTexelSolidAngle(int x, int y, int side) {
  const auto at = [&](int column, int row) {
    return cornerSolidAngle(2. * column / side - 1, 2. * row / side - 1);
  };
  return at(x + 1, y + 1) - at(x, y + 1) - at(x + 1, y) + at(x, y);
}

}  // namespace

double texelSolidAngle(int row, int width, int height) {
  // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2), without cancellation near the poles.
  const double middle = kPiD * (row + 0.5) / height, half = 0.5 * kPiD / height;
  return 2 * kPiD / width * 2 * std::sin(middle) * std::sin(half);
}

double solidAngleJacobian(Mapping mapping, const dvec2& uv) {
  if (mapping == Mapping::LatLong) return 2 * kPiD * kPiD * std::sin(kPiD * uv.y);
  if (const std::optional<Fisheye> lens = mapping.disc())
    return 4 * lens->solidAngleJacobian(std::hypot(2 * uv.x - 1, 2 * uv.y - 1));
  // A cube's face spans [-1, 1]^2 at distance 1: d(omega) = (1 + s^2 + t^2)^(-3/2) ds dt.
  const auto [columns, rows] = faceLayout(mapping);
  const double x = uv.x * columns, y = uv.y * rows;
  const double s = 2 * (x - std::floor(x)) - 1, t = 2 * (y - std::floor(y)) - 1;
  return 4 * columns * rows * std::pow(1 + s * s + t * t, -1.5);
}

TexelSolidAngles texelSolidAngles(Mapping mapping, const ImageSize& image) {
  TexelSolidAngles angles{4 * kPiD, 0, 0};
  const auto add = [&](double solidAngle, size_t texels) {
    angles.min = std::min(angles.min, solidAngle);
    angles.max = std::max(angles.max, solidAngle);
    angles.texels += texels;
  };
  const auto [columns, rows] = faceLayout(mapping);
  if (mapping == Mapping::LatLong) {
    for (int y = 0; y < image.height; ++y)
      add(texelSolidAngle(y, image.width, image.height), size_t(image.width));
  } else if (columns * rows > 1) {
    const int side = image.width / columns;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) add(faceTexelSolidAngle(x, y, side), 6);
  } else {
    const double area = 1 / (double(image.width) * image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const dvec2 uv((x + 0.5) / image.width, (y + 0.5) / image.height);
        if (showsDirection(mapping, uv)) add(area * solidAngleJacobian(mapping, uv), 1);
      }
  }
  return angles;
}

dvec3 meanRadiance(const Image& latLong) {
  dvec3 sum(0);
  for (int y = 0; y < latLong.height; ++y) {
    dvec3 row(0);
    for (int x = 0; x < latLong.width; ++x) row += dvec3(latLong.rgb(x, y));
    sum += row * texelSolidAngle(y, latLong.width, latLong.height);
  }
  return sum / (4 * kPiD);
}

}  // namespace chromeball

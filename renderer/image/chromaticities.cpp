// SPDX-License-Identifier: Apache-2.0
#include "image/chromaticities.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <cmath>

namespace chromeball {
namespace {

using glm::dmat3, glm::dvec2, glm::dvec3;

dvec3 xyzOf(const dvec2& xy) { return {xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y}; }

bool isFiniteMatrix(const dmat3& m) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

// The matrix from RGB to XYZ, with the white at luminance 1 (SMPTE RP 177).
std::optional<dmat3> rgbToXyz(const Chromaticities& space) {
  const auto lifted = [](const dvec2& xy) { return dvec3(xy, 1 - xy.x - xy.y); };
  const dmat3 primaries(lifted(space.red), lifted(space.green), lifted(space.blue));
  constexpr double kMinDeterminant = 1e-6, kMinShare = 1e-6;
  if (!(std::abs(glm::determinant(primaries)) > kMinDeterminant) || !(space.white.y > 0)) return {};
  const dvec3 shares = glm::inverse(primaries) * xyzOf(space.white);
  for (int c = 0; c < 3; ++c)
    if (!(shares[c] > kMinShare)) return {};
  dmat3 matrix = primaries;
  for (int c = 0; c < 3; ++c) matrix[c] *= shares[c];
  return isFiniteMatrix(matrix) ? std::optional(matrix) : std::nullopt;
}

dmat3 adaptation(const dvec2& from, const dvec2& to) {
  const dmat3 cones = glm::transpose(
      dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const dvec3 scale = cones * xyzOf(to) / (cones * xyzOf(from));
  dmat3 scaled = cones;
  for (int c = 0; c < 3; ++c) scaled[c] *= scale;
  return glm::inverse(cones) * scaled;
}

bool isClose(const dvec2& a, const dvec2& b) {
  constexpr double kTolerance = 1e-3;
  return std::abs(a.x - b.x) < kTolerance && std::abs(a.y - b.y) < kTolerance;
}

// Whether this is CIE XYZ itself, which measures light: its "white" is none that a viewer would
// adapt to.
bool isXyz(const Chromaticities& space) {
  return isClose(space.red, {1, 0}) && isClose(space.green, {0, 1}) && isClose(space.blue, {0, 0});
}

}  // namespace

bool isRec709(const Chromaticities& space) {
  const Chromaticities rec709;
  return isClose(space.red, rec709.red) && isClose(space.green, rec709.green) &&
         isClose(space.blue, rec709.blue) && isClose(space.white, rec709.white);
}

std::optional<glm::dmat3> toRec709(const Chromaticities& space) {
  const Chromaticities rec709;
  const std::optional<dmat3> xyz = rgbToXyz(space);
  if (!xyz) return {};
  const dmat3 adapted = isXyz(space) ? *xyz : adaptation(space.white, rec709.white) * *xyz;
  const dmat3 matrix = glm::inverse(*rgbToXyz(rec709)) * adapted;
  return isFiniteMatrix(matrix) ? std::optional(matrix) : std::nullopt;
}

void convertColor(Image& image, const glm::dmat3& matrix) {
  for (size_t i = 0; i < image.pixels(); ++i) image.setRgb(i, Rgb(matrix * dvec3(image.rgb(i))));
}

Message conversionNote(const std::filesystem::path& path, const Chromaticities& from) {
  return makeNote(
      "{}: its colour is converted to Rec. 709 from red ({:.4g}, {:.4g}), green "
      "({:.4g}, {:.4g}), blue ({:.4g}, {:.4g}), white ({:.4g}, {:.4g})",
      path.string(), from.red.x, from.red.y, from.green.x, from.green.y, from.blue.x, from.blue.y,
      from.white.x, from.white.y);
}

}  // namespace chromeball

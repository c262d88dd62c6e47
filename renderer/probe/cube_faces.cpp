// SPDX-License-Identifier: Apache-2.0
#include "probe/cube_faces.h"

#include <fmt/format.h>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr int kFaces = 6, kPx = 0, kNx = 1, kPz = 4, kNz = 5;

float lightAt(const Image& image, int x, int y) {
  return maxComponent(glm::max(image.rgb(x, y), Rgb(0)));
}

// How unlike two texels are: tanh^2 of half the difference of their logarithms, 0 for black ones.
double unlikeness(double a, double b) {
  const double ratio = a + b > 0 && std::isfinite(a + b) ? (a - b) / (a + b) : 0;
  return ratio * ratio;
}

// How clearly the edges fit OpenEXR's axes (positive) or those of a graphics API: Student's t of
// the difference of unlikeness, in units of what is exceeded by chance once in 10,000 times.
//
// The two differ in whether pz or nz is to the right of px. One sample is the sum over the two
// edges that exchange their neighbours, so that faces that differ in brightness add nothing to the
// scatter, and the mean over a run of rows, because noise may be correlated from row to row.
double axesThatFit(const Image& strip) {
  constexpr int kRuns = 32;  // at most, along an edge
  constexpr double kByChance = 1e-4;
  const int n = strip.height, runs = std::min(n, kRuns);
  const auto atSeam = [&](int left, int right, int y) {
    return unlikeness(lightAt(strip, left * n + n - 1, y), lightAt(strip, right * n, y));
  };
  double sum = 0, sumOfSquares = 0;
  for (const auto& [a, b, c, d] : {std::array{kPx, kNx, kPz, kNz}, std::array{kPz, kNz, kNx, kPx}})
    for (int run = 0; run < runs; ++run) {
      double mean = 0;
      const int begin = run * n / runs, end = (run + 1) * n / runs;
      for (int y = begin; y < end; ++y)
        mean +=
            (atSeam(a, d, y) + atSeam(b, c, y) - atSeam(a, c, y) - atSeam(b, d, y)) / (end - begin);
      sum += mean;
      sumOfSquares += mean * mean;
    }
  const double count = 2.0 * runs, degreesOfFreedom = count - 1;
  const double variance = std::max(sumOfSquares - sum * sum / count, 0.0) / degreesOfFreedom;
  const double quantile =
      boost::math::quantile(complement(boost::math::students_t(degreesOfFreedom), kByChance));
  return sum == 0 ? 0 : sum / (quantile * std::sqrt(count * variance));
}

void swapFaces(Image& strip, int a, int b) {
  const int n = strip.height;
  for (int y = 0; y < n; ++y)
    std::swap_ranges(strip.at(a * n, y), strip.at(a * n, y) + n * strip.channels,
                     strip.at(b * n, y));
}

// Puts the faces of a graphics API, in which pz is the front, where OpenEXR's names of the axes
// would have them. Most programs that write six files are such.
void orientAxes(const fs::path& folder, ImageFile& file) {
  const double fit = axesThatFit(file.image);
  const bool isOpenExr = fit > 1;
  if (!isOpenExr) swapFaces(file.image, kPz, kNz);
  addNote(file.messages, "{}: read as a cube map, the face pz as {}", folder.string(),
          isOpenExr ? "+Z: the edges fit as in OpenEXR"
          : fit < -1
              ? "its front, -Z: the edges fit as in OpenGL and Direct3D"
              : "its front, -Z, as in OpenGL and Direct3D: the edges do not tell; files named "
                "right, left, top, bottom, back, front leave no doubt");
}

// Names that say which face is where may have been given to the wrong ones.
void checkNames(const fs::path& folder, ImageFile& file) {
  if (axesThatFit(file.image) < -1)
    addWarning(
        file.messages,
        "{}: the edges of its faces would fit with front and back exchanged; front is -Z, where "
        "a camera looks that is not turned",
        folder.string());
}

}  // namespace

ImageFile readCubeFaces(const fs::path& folder, const CubeFaces& faces) {
  ImageFile cube{.image = {}, .channels = {"R", "G", "B"}, .metadata = {}};
  cube.metadata[kMappingAttribute] = "cube-strip";
  for (int face = 0; face < kFaces; ++face) {
    const fs::path& path = faces.files[size_t(face)];
    ImageFile file = readImageFile(path);
    cube.integers |= file.integers;
    cube.messages.insert(cube.messages.end(), file.messages.begin(), file.messages.end());
    const Image image = colorOf(std::move(file), path);
    const int n = image.width;
    if (n != image.height)
      throwInput("{}: is {} x {}; the face of a cube map must be square", path.string(), n,
                 image.height);
    if (cube.image.empty()) {
      checkImageSize(folder, int64_t(kFaces) * n, n, 3);
      checkImageMemory(folder, int64_t(kFaces) * n, n, 3);
      cube.image = Image(kFaces * n, n, 3);
    }
    if (n != cube.image.height)
      throwInput("{}: is {} x {}, but {} is {} x {}", path.string(), n, n,
                 faces.files[0].filename().string(), cube.image.height, cube.image.height);
    for (int y = 0; y < n; ++y)
      std::copy_n(image.at(0, y), 3 * size_t(n), cube.image.at(face * n, y));
  }
  faces.namesAxes ? orientAxes(folder, cube) : checkNames(folder, cube);
  return cube;
}

}  // namespace chromeball

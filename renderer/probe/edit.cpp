// SPDX-License-Identifier: Apache-2.0
#include "probe/edit.h"

#include <fmt/format.h>

#include <atomic>
#include <complex>
#include <limits>
#include <vector>

#include "base/parallel.h"

namespace chromeball {
namespace {

bool isBelowHorizon(int row, const Image& latLong) { return 2 * row >= latLong.height; }

// The Fourier series of one channel of a row, about its azimuth: coefficients 0 to (width - 1) / 2.
class RowSeries {
 public:
  RowSeries(const Image& image, int row, int channel)
      : coefficients_(size_t(image.width + 1) / 2), turn_(size_t(image.width)) {
    const auto width = size_t(image.width);
    for (size_t i = 0; i < width; ++i) turn_[i] = std::polar(1.0, 2 * kPiD * double(i) / width);
    parallelFor(size_t(0), coefficients_.size(), [&](size_t m) {
      std::complex<double> sum = 0;
      for (size_t x = 0; x < width; ++x)
        sum += double(image.at(int(x), row)[channel]) * std::conj(turn_[m * x % width]);
      coefficients_[m] = sum / double(width);
    });
    minimum_ = maximum_ = image.at(0, row)[channel];
    for (int x = 1; x < image.width; ++x) {
      minimum_ = std::min(minimum_, image.at(x, row)[channel]);
      maximum_ = std::max(maximum_, image.at(x, row)[channel]);
    }
  }

  // The harmonic function in the disc that this row bounds, at `radius` below 1 in the plane: each
  // coefficient m times radius^m. It is within the range of the row, apart from the terms left out.
  float inside(double radius, int column) const {
    constexpr double kNegligible = 1e-5;
    double sum = coefficients_[0].real(), power = radius;
    for (size_t m = 1; m < coefficients_.size() && power > kNegligible; ++m, power *= radius)
      sum += 2 * power * (coefficients_[m] * turn_[m * size_t(column) % turn_.size()]).real();
    return std::clamp(float(sum), minimum_, maximum_);
  }

 private:
  std::vector<std::complex<double>> coefficients_, turn_;
  float minimum_ = 0, maximum_ = 0;
};

constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool hasNan(const Rgb& c) { return std::isnan(c.x) || std::isnan(c.y) || std::isnan(c.z); }

// Replaces negative and infinite channels; keeps NaN.
Rgb repairChannels(Rgb c, float largest) {
  for (int i = 0; i < 3; ++i) {
    if (c[i] < 0) c[i] = 0;
    if (c[i] == kInfinity) c[i] = largest;
  }
  return c;
}

Rgb meanOfNeighbours(const Image& image, int x, int y, bool wrapX, float largest) {
  glm::dvec3 sum(0);
  int count = 0;
  for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, image.height - 1); ++ny)
    for (int dx = -1; dx <= 1; ++dx) {
      int nx = x + dx;
      if (wrapX) nx = (nx + image.width) % image.width;
      if (nx < 0 || nx >= image.width) continue;
      const Rgb neighbour = image.rgb(nx, ny);
      if (hasNan(neighbour)) continue;
      sum += glm::dvec3(repairChannels(neighbour, largest));
      ++count;
    }
  return count > 0 ? Rgb(sum / double(count)) : Rgb(0);
}

bool isValid(const Image& image) {
  std::atomic<bool> valid = true;
  forRanges(size_t(image.height), size_t(image.width), [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end && valid; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Rgb c = image.rgb(x, int(y));
        if (!isFinite(c) || c.x < 0 || c.y < 0 || c.z < 0) valid = false;
      }
  });
  return valid;
}

}  // namespace

void replaceBelowHorizon(Image& latLong, const Rgb& radiance) {
  for (int y = 0; y < latLong.height; ++y) {
    const bool isHalfBelow = 2 * y + 1 == latLong.height;
    for (int x = 0; x < latLong.width; ++x)
      if (isHalfBelow)
        latLong.setRgb(x, y, 0.5f * latLong.rgb(x, y) + 0.5f * radiance);
      else if (isBelowHorizon(y, latLong))
        latLong.setRgb(x, y, radiance);
  }
}

void mirrorAtHorizon(Image& latLong) {
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; isBelowHorizon(y, latLong) && x < latLong.width; ++x)
      latLong.setRgb(x, y, latLong.rgb(x, latLong.height - 1 - y));
}

void mirrorLeftAndRight(Image& latLong) {
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; 2 * x < latLong.width - 1; ++x)
      std::swap_ranges(latLong.at(x, y), latLong.at(x, y) + 3,
                       latLong.at(latLong.width - 1 - x, y));
}

size_t multiplyRegion(Image& latLong, const dvec3& centre, double radius, const Rgb& gain) {
  const double cosRadius = std::cos(radius * kPiD / 180);
  size_t count = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      if (glm::dot(texelDirection({latLong.width, latLong.height}, x, y), centre) >= cosRadius) {
        latLong.setRgb(x, y, latLong.rgb(x, y) * gain);
        ++count;
      }
  return count;
}

void multiply(Image& latLong, const Rgb& scale) {
  recolor(latLong, [&](const Rgb& c) { return c * scale; });
}

void clip(Image& latLong, float limit) {
  recolor(latLong, [&](const Rgb& c) { return glm::min(c, Rgb(limit)); });
}

// Harmonic functions stay so under the stereographic projection from the zenith, which takes the
// angle a from the nadir to the radius tan(a / 2).
int fillNadir(Image& latLong, double radius) {
  const auto angle = [&](int row) { return kPiD * (latLong.height - row - 0.5) / latLong.height; };
  int first = latLong.height;
  while (first > 0 && angle(first - 1) < radius * kPiD / 180) --first;
  if (first == latLong.height || first == 0) return 0;
  const double rim = std::tan(0.5 * angle(first - 1));
  for (int channel = 0; channel < 3; ++channel) {
    const RowSeries series(latLong, first - 1, channel);
    parallelFor(first, latLong.height, [&](int y) {
      for (int x = 0; x < latLong.width; ++x)
        latLong.at(x, y)[channel] = series.inside(std::tan(0.5 * angle(y)) / rim, x);
    });
  }
  return latLong.height - first;
}

RepairReport repair(Image& image, bool wrapX) {
  RepairReport report;
  if (isValid(image)) return report;
  float largest = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = image.rgb(x, y);
      for (int i = 0; i < 3; ++i)
        if (std::isfinite(c[i])) largest = std::max(largest, c[i]);
      const bool negative = c.x < 0 || c.y < 0 || c.z < 0;
      if (isFinite(c) && !negative) continue;
      if (report.total() == 0) report.firstX = x, report.firstY = y;
      ++(hasNan(c) ? report.nan : isFinite(c) ? report.negative : report.infinite);
    }

  constexpr float kBright = 0.5f;  // of the largest
  for (size_t i = 0; i < image.pixels() && !report.isBrightest; ++i) {
    const Rgb c = image.rgb(i);
    const bool isLost = hasNan(c) || (isFinite(c) && (c.x < 0 || c.y < 0 || c.z < 0));
    for (int k = 0; k < 3; ++k)
      report.isBrightest |= isLost && c[k] > 0 && c[k] >= kBright * largest;
  }

  // All NaN texels are filled from the original neighbours before any is replaced.
  std::vector<std::pair<size_t, Rgb>> filled;
  for (int y = 0; y < image.height && report.nan > 0; ++y)
    for (int x = 0; x < image.width; ++x)
      if (hasNan(image.rgb(x, y)))
        filled.emplace_back(size_t(y) * image.width + x,
                            meanOfNeighbours(image, x, y, wrapX, largest));
  for (const auto& [index, color] : filled)
    image.setRgb(int(index % image.width), int(index / image.width), color);
  recolor(image, [&](const Rgb& c) { return repairChannels(c, largest); });
  return report;
}

std::string describe(const RepairReport& report) {
  return fmt::format("{} NaN, {} infinite, {} negative texels, the first at ({}, {}){}", report.nan,
                     report.infinite, report.negative, report.firstX, report.firstY,
                     report.isBrightest ? ", also where it is brightest: the colour and the amount "
                                          "of that light, such as a sun's, are lost"
                                        : "");
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "probe/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"

namespace chromeball {
namespace {

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
  if (report.total() == 0) return report;

  // All NaN texels are filled from the original neighbours before any is replaced.
  std::vector<std::pair<size_t, Rgb>> filled;
  for (int y = 0; y < image.height && report.nan > 0; ++y)
    for (int x = 0; x < image.width; ++x)
      if (hasNan(image.rgb(x, y)))
        filled.emplace_back(size_t(y) * image.width + x,
                            meanOfNeighbours(image, x, y, wrapX, largest));
  for (const auto& [index, color] : filled)
    image.setRgb(int(index % image.width), int(index / image.width), color);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.setRgb(x, y, repairChannels(image.rgb(x, y), largest));
  return report;
}

std::string describe(const RepairReport& report) {
  return fmt::format("{} NaN, {} infinite, {} negative texels, the first at ({}, {})", report.nan,
                     report.infinite, report.negative, report.firstX, report.firstY);
}

}  // namespace chromeball

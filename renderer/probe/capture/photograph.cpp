// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/photograph.h"

#include <fmt/format.h>

#include "base/error.h"
#include "image/io/read_image.h"
#include "probe/edit.h"

namespace chromeball {

// The mean over strips of the chord that is inside, each weighted by its length.
double shareInside(const Circle& circle, int width, int height) {
  constexpr int kStrips = 400;
  double inside = 0, all = 0;
  for (int i = 0; i < kStrips; ++i) {
    const double down = 2 * (i + 0.5) / kStrips - 1;  // in radii
    const double half = std::sqrt(1 - down * down) * circle.radius;
    const double y = circle.centre.y + down * circle.radius;
    all += 2 * half;
    if (y < 0 || y > height) continue;
    const double left = std::max(circle.centre.x - half, 0.0);
    const double right = std::min(circle.centre.x + half, double(width));
    inside += std::max(right - left, 0.0);
  }
  return inside / all;
}

LoadedPhotograph loadPhotograph(const std::filesystem::path& path) {
  ImageFile file = readImageFile(path);
  LoadedPhotograph photograph;
  photograph.messages = file.messages;
  const Messages clipped = clippedLight(file, path);
  photograph.messages.insert(photograph.messages.end(), clipped.begin(), clipped.end());
  photograph.image = colorOf(std::move(file), path);
  const RepairReport repaired = repair(photograph.image, false);
  if (repaired.total() > 0)
    addWarning(photograph.messages, "{}: repaired {}", path.string(), describe(repaired));
  return photograph;
}

Image loadMask(const std::filesystem::path& path, const Image& photograph,
               const std::filesystem::path& photographPath, Messages& messages) {
  ImageFile file = readImageFile(path, IntegerTexels::Linear);
  messages.insert(messages.end(), file.messages.begin(), file.messages.end());
  const Image color = maskOf(std::move(file), path);
  if (color.width != photograph.width || color.height != photograph.height)
    throwInput("{}: {} x {} texels should be {} x {}, as in {}", path.string(), color.width,
               color.height, photograph.width, photograph.height, photographPath.string());
  Image mask(color.width, color.height, 1);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const float brightest = maxComponent(color.rgb(x, y));
      *mask.at(x, y) = brightest > 0 ? std::min(brightest, 1.f) : 0;  // NaN counts as 0
    }
  return mask;
}

PhotographDisc::PhotographDisc(const Image& image, const Circle& circle, const Image& mask)
    : image_(image), circle_(circle), mask_(mask) {}

double PhotographDisc::weight(int x, int y) const {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return 0;
  const double halfDiagonal = std::sqrt(0.5);
  const glm::dvec2 fromCentre = glm::dvec2(x + 0.5, y + 0.5) - circle_.centre;
  if (glm::length(fromCentre) > circle_.radius - halfDiagonal) return 0;
  return mask_.empty() ? 1 : double(*mask_.at(x, y));
}

PhotographDisc::Sample PhotographDisc::at(const glm::dvec2& position) const {
  constexpr double kRim = 0.75;  // pixels
  glm::dvec2 fromCentre = circle_.radius * glm::dvec2(position.x, -position.y);
  const double distance = glm::length(fromCentre), largest = circle_.radius - kRim;
  if (distance > largest) fromCentre *= largest / distance;
  const glm::dvec2 corner = circle_.centre + fromCentre - 0.5, floor = glm::floor(corner);
  const glm::dvec2 part = corner - floor;
  Sample sum{glm::dvec3(0), 0};
  for (int k = 0; k < 4; ++k) {
    const int dx = k & 1, dy = k >> 1, x = int(floor.x) + dx, y = int(floor.y) + dy;
    const double w = (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y) * weight(x, y);
    if (w == 0) continue;
    sum.radiance += w * glm::dvec3(image_.rgb(x, y));
    sum.coverage += w;
  }
  if (sum.coverage > 0) sum.radiance /= sum.coverage;
  return sum;
}

}  // namespace chromeball

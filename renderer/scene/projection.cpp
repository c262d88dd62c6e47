// SPDX-License-Identifier: Apache-2.0
#include "scene/projection.h"

namespace chromeball {

Projection::Projection(const Camera& camera, int width, int height)
    : view_(camera, double(width) / height), colors_(width, height, 3), depth_(width, height, 1) {}

void Projection::setDepth(const Image& farthest) {
  depth_ = farthest;
  for (int y = 0; y < depth_.height; ++y)
    for (int x = 0; x < depth_.width; ++x) {
      if (!(*farthest.at(x, y) > 0)) continue;
      float& depth = *depth_.at(x, y);
      for (int row = std::max(y - 1, 0); row <= std::min(y + 1, depth_.height - 1); ++row)
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, depth_.width - 1); ++column)
          depth = std::max(depth, *farthest.at(column, row));
    }
}

std::optional<Rgb> Projection::lookup(const vec3& point) const {
  constexpr double kTolerance = 1e-3;  // of the depth
  const auto seen = view_.at(glm::dvec3(point));
  if (!seen) return std::nullopt;
  const double x = seen->position.x * colors_.width, y = seen->position.y * colors_.height;
  if (!(x >= 0 && x < colors_.width && y >= 0 && y < colors_.height)) return std::nullopt;
  const double farthest = *depth_.at(int(x), int(y));
  if (!(farthest > 0) || seen->depth > (1 + kTolerance) * farthest) return std::nullopt;
  return colors_.rgb(int(x), int(y));
}

}  // namespace chromeball

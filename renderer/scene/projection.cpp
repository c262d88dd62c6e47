// SPDX-License-Identifier: Apache-2.0
#include "scene/projection.h"

namespace chromeball {

Projection::Projection(const Camera& camera, int width, int height)
    : orthographic_(camera.orthographic),
      position_(camera.position),
      forward_(-camera.back),
      colors_(width, height, 3),
      depth_(width, height, 1) {
  const float halfHeight = orthographic_ ? camera.halfHeight : std::tan(0.5f * camera.fov);
  const float pixel = 2 * halfHeight / float(height);
  across_ = camera.right / pixel;
  down_ = -camera.up / pixel;
}

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
  constexpr float kTolerance = 1e-3f;  // of the depth
  const vec3 to = point - position_;
  const float z = glm::dot(to, forward_);
  if (!(z > 0)) return std::nullopt;
  const float scale = orthographic_ ? 1 : 1 / z;
  const float x = scale * glm::dot(to, across_) + 0.5f * float(colors_.width);
  const float y = scale * glm::dot(to, down_) + 0.5f * float(colors_.height);
  if (!(x >= 0 && x < float(colors_.width) && y >= 0 && y < float(colors_.height)))
    return std::nullopt;
  const float farthest = *depth_.at(int(x), int(y));
  if (!(farthest > 0) || z > (1 + kTolerance) * farthest) return std::nullopt;
  return colors_.rgb(int(x), int(y));
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_view.h"

namespace chromeball {

using glm::dvec2, glm::dvec3;

CameraView::CameraView(const Camera& camera, double aspectRatio)
    : orthographic_(camera.orthographic),
      position_(camera.position),
      toCamera_(
          glm::transpose(glm::dmat3(dvec3(camera.right), dvec3(camera.up), dvec3(-camera.back)))),
      axis_(camera.orthographic ? vec2(0.5f) : camera.principalPoint),
      distortion_(camera.orthographic ? Distortion() : camera.distortion),
      fold_(distortion_.fold()) {
  const double halfHeight =
      orthographic_ ? double(camera.halfHeight) : std::tan(0.5 * double(camera.fov));
  scale_ = dvec2(0.5 / (halfHeight * aspectRatio), -0.5 / halfHeight);
}

std::optional<CameraView::Point> CameraView::at(const dvec3& point) const {
  const dvec3 p = toCamera_ * (point - position_);
  if (!(p.z > 0)) return std::nullopt;
  if (orthographic_) return Point{axis_ + scale_ * dvec2(p), p.z};
  dvec2 seen = dvec2(p) / p.z;
  if (distortion_) {
    const double r2 = glm::dot(seen, seen);
    if (!(r2 < fold_ * fold_)) return std::nullopt;
    seen *= distortion_.factor(r2);
  }
  return Point{axis_ + scale_ * seen, p.z};
}

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

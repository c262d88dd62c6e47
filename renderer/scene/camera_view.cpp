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

}  // namespace chromeball

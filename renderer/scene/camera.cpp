// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

#include <cmath>
#include <initializer_list>
#include <limits>

#include "base/error.h"
#include "math/warp.h"
#include "scene/motion.h"

namespace chromeball {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The smallest positive root of 1 + b t + a t^2; infinite if there is none.
double firstRoot(double a, double b) {
  const double discriminant = b * b - 4 * a;
  if (discriminant < 0) return kInfinity;
  // The product of the roots is 1 / a, so that neither needs a difference of like numbers.
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double first = kInfinity;
  for (const double root : {q / a, 1 / q})
    if (root > 0 && root < first) first = root;
  return first;
}

}  // namespace

double Distortion::fold() const { return std::sqrt(firstRoot(5 * k2, 3 * k1)); }

double Distortion::distortedFold() const {
  const double radius = fold();
  return std::isinf(radius) ? radius : distorted(radius);
}

// Uses Newton's method, and bisection where that leaves the interval with the root.
double Distortion::undistorted(double radius) const {
  constexpr int kMaxSteps = 100;
  double low = 0, high = fold();
  if (!reaches(radius)) return high;
  if (std::isinf(high))
    for (high = radius; distorted(high) < radius;) high *= 2;
  double r = radius < high ? radius : 0.5 * high;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double excess = distorted(r) - radius;
    (excess > 0 ? high : low) = r;
    double next = r - excess / slope(r);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - r) <= 1e-15 * r) return next;
    r = next;
  }
  return r;
}

CameraRays::CameraRays(const Camera& camera, float aspectRatio)
    : orthographic_(camera.orthographic),
      position_(camera.position),
      forward_(-camera.back),
      right_(camera.right),
      up_(camera.up),
      lensRadius_(camera.orthographic ? 0 : camera.lensRadius),
      focus_(camera.focus),
      distorts_(!camera.orthographic && camera.distortion),
      distortion_(camera.distortion) {
  const float halfHeight = orthographic_ ? camera.halfHeight : std::tan(0.5f * camera.fov);
  across_ = 2 * halfHeight * aspectRatio * camera.right;
  down_ = -2 * halfHeight * camera.up;
  const vec2 axis = orthographic_ ? vec2(0.5f) : camera.principalPoint;
  corner_ = -(axis.x * across_ + axis.y * down_);
  if (!orthographic_) corner_ += forward_;
}

vec3 CameraRays::undistorted(const vec3& point) const {
  const vec3 offset = point - forward_;
  const double radius = glm::length(glm::dvec3(offset));
  if (radius == 0) return point;
  return forward_ + float(distortion_.undistorted(radius) / radius) * offset;
}

// The lens changes lengths along the radius by 1 / slope, and across it by the ratio of the radii.
Beam CameraRays::beamAt(const Beam& central, float u, float v) const {
  if (!distorts_) return central;
  const double radius = glm::length(glm::dvec3(pointAt(u, v) - forward_));
  const double area = 1 / (distortion_.slope(radius) * distortion_.factor(radius * radius));
  return {central.area, float(area) * central.solidAngle};
}

bool fillsImage(const Camera& camera, double aspectRatio) {
  if (camera.orthographic || !camera.distortion) return true;
  const glm::dvec2 axis(camera.principalPoint);
  const glm::dvec2 farthest = glm::max(axis, 1.0 - axis) * glm::dvec2(aspectRatio, 1);
  return camera.distortion.reaches(2 * std::tan(0.5 * double(camera.fov)) * glm::length(farthest));
}

void CameraRays::ray(float u, float v, vec2 lens, vec3& origin, vec3& direction) const {
  // The projection of the cosine-weighted hemisphere is a uniform disc.
  const vec2 disc = lensRadius_ * vec2(squareToCosineHemisphere(lens));
  const vec3 onLens = disc.x * right_ + disc.y * up_;
  origin = position_ + onLens;
  direction = glm::normalize(focus_ * pointAt(u, v) - onLens);
}

Beam beamOf(const Camera& camera, int height, double samples) {
  const double halfHeight =
      camera.orthographic ? camera.halfHeight : std::tan(0.5 * double(camera.fov));
  const double side = 2 * halfHeight / height;
  // Among the overlaps 1, 2, 4 and 8, this one has the smallest error for 16 samples of a
  // checkerboard.
  constexpr double kOverlap = 4;
  const float fraction = float(side * side * std::min(kOverlap / samples, 1.0));
  return camera.orthographic ? Beam{fraction, 0} : Beam{0, fraction};
}

Camera Camera::lookAt(vec3 position, vec3 target, vec3 up, float fovRadians) {
  const glm::dvec3 view = glm::dvec3(position) - glm::dvec3(target);
  const double distance = glm::length(view);
  if (!(distance > 0) || !std::isfinite(distance))
    throwInput("camera: position and look_at are the same point, or not finite");
  const glm::dvec3 back = view / distance;
  const glm::dvec3 side = glm::cross(glm::dvec3(up), back);
  const double sideLength = glm::length(side);
  if (!(sideLength > 1e-6 * glm::length(glm::dvec3(up))))
    throwInput("camera: up is zero or parallel to the view");

  Camera camera;
  camera.position = position;
  camera.right = vec3(side / sideLength);
  camera.up = vec3(glm::cross(back, side / sideLength));
  camera.back = vec3(back);
  camera.fov = fovRadians;
  return camera;
}

Camera Camera::turnedAround(const vec3& centre, double degrees) const {
  if (degrees == 0) return *this;
  const glm::dvec3 forward = -glm::dvec3(back);
  const double distance =
      std::max(0.0, glm::dot(glm::dvec3(centre) - glm::dvec3(position), forward));
  const glm::dvec3 pivot = glm::dvec3(position) + distance * forward;
  const glm::dquat turn = glm::angleAxis(glm::radians(degrees), glm::dvec3(0, 1, 0));
  Camera turned = *this;
  turned.position = vec3(pivot + turn * (glm::dvec3(position) - pivot));
  turned.right = vec3(turn * glm::dvec3(right));
  turned.up = vec3(turn * glm::dvec3(up));
  turned.back = vec3(turn * glm::dvec3(back));
  return turned;
}

void ViewAngles::orient(Camera& camera) const {
  const double a = glm::radians(azimuth), e = glm::radians(elevation), r = glm::radians(roll);
  const glm::dvec3 back(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  const glm::dvec3 level(std::cos(a), 0, -std::sin(a)), above = glm::cross(back, level);
  camera.back = vec3(back);
  camera.right = vec3(std::cos(r) * level + std::sin(r) * above);
  camera.up = vec3(std::cos(r) * above - std::sin(r) * level);
}

MovingCamera::MovingCamera(const Camera& camera, float aspectRatio)
    : lens_(camera), aspectRatio_(aspectRatio) {
  lens_.name.clear(), lens_.node.clear();  // at() must not allocate
  lens_.motion = nullptr;
  for (const Camera& key : *camera.motion)
    keys_.push_back(
        {key.position, glm::quat_cast(mat3(key.right, key.up, key.back)), key.fov, key.halfHeight});
}

Camera MovingCamera::cameraAt(float time) const {
  const KeySpan span = keysAround(keys_.size(), time);
  const Key &from = keys_[span.from], &to = keys_[span.to];
  const mat3 frame = glm::mat3_cast(glm::slerp(from.frame, to.frame, span.fraction));
  Camera camera = lens_;
  camera.position = glm::mix(from.position, to.position, span.fraction);
  camera.right = frame[0], camera.up = frame[1], camera.back = frame[2];
  camera.fov = glm::mix(from.fov, to.fov, span.fraction);
  camera.halfHeight = glm::mix(from.halfHeight, to.halfHeight, span.fraction);
  return camera;
}

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

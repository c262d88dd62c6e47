// SPDX-License-Identifier: Apache-2.0
// Cameras and their rays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// Radial distortion of a lens.

// The point (x, y) of the plane at distance 1 in front of the lens appears where a pinhole would
// show (1 + k1 r^2 + k2 r^4) (x, y), with r^2 = x^2 + y^2 (Brown 1971, the radial terms; the
// coefficients of OpenCV). Negative k1 is a barrel. A radius is a point's distance from the axis in
// this plane, before (undistorted) or after (distorted) the lens.
struct Distortion {
  double k1 = 0, k2 = 0;

  explicit operator bool() const { return k1 != 0 || k2 != 0; }
  bool operator==(const Distortion&) const = default;

  double factor(double r2) const { return 1 + r2 * (k1 + r2 * k2); }
  double distorted(double radius) const { return radius * factor(radius * radius); }
  // The derivative of distorted().
  double slope(double radius) const {
    const double r2 = radius * radius;
    return 1 + r2 * (3 * k1 + r2 * 5 * k2);
  }

  // The undistorted radius where the picture folds back: distorted() ascends up to there. Infinite
  // if it always ascends.
  double fold() const;

  // Whether one point, and no other before the fold, appears at this distorted radius.
  bool reaches(double radius) const { return radius < distortedFold(); }

  // The inverse of distorted() before the fold; the fold if no point appears at `radius`.
  double undistorted(double radius) const;

 private:
  double distortedFold() const;
};

// Looks along -Z of its frame, +Y up (glTF's convention). Positions in metres.
struct Camera {
  std::string name, node;  // names of the camera and of its node in the model
  vec3 position{0, 0, 0};
  vec3 right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1};  // orthonormal
  bool orthographic = false;
  float fov = 0.6911112f;  // vertical field of view in radians (perspective)
  float halfHeight = 1;    // half the height of the view in metres (orthographic)
  float aspect = 0;        // width / height that the file states; 0: none
  float lensRadius = 0;    // metres; 0: a pinhole. Perspective only
  float focus = 1;         // metres along the axis to the plane in focus; used if there is a lens
  // Perspective only. The point where the axis meets the image, as fractions of its width and
  // height from the top left. `fov` is the field of view of an image of this height around the
  // axis, without distortion: half the height is tan(fov / 2) focal lengths.
  vec2 principalPoint{0.5f, 0.5f};
  Distortion distortion;
  // Its keys while the shutter is open; null: it stands still.
  std::shared_ptr<const std::vector<Camera>> motion = nullptr;

  // Throws InputError if position and target coincide or if up is parallel to the view.
  static Camera lookAt(vec3 position, vec3 target, vec3 up, float fovRadians);

  // The camera after a turn about the vertical (Y) through the point of its line of sight that is
  // nearest to `centre`; counter-clockwise seen from above.
  Camera turnedAround(const vec3& centre, double degrees) const;
};

// The direction from which a camera looks, in degrees: from the front (+Z) counter-clockwise seen
// from above, and upwards. A positive roll turns the camera counter-clockwise as its user sees it.
struct ViewAngles {
  double azimuth = 0, elevation = 0, roll = 0;

  void orient(Camera& camera) const;  // at its position
  bool operator==(const ViewAngles&) const = default;
};

// The beam around a camera ray. Its cross-section after `distance` metres is
// area + solidAngle distance^2, in m^2.
struct Beam {
  float area = 0, solidAngle = 0;  // both 0: an infinitely thin ray

  explicit operator bool() const { return area + solidAngle > 0; }
  float crossSection(float distance) const { return area + solidAngle * distance * distance; }
};

// The beam of one of `samples` rays through a pixel at the centre of an image of `height` pixels.
// The sum of the beams' areas is four times the pixel's area: less would alias textures, more would
// blur them.
Beam beamOf(const Camera& camera, int height, double samples);

// Whether the distortion shows one point at every position of an image of this width / height.
bool fillsImage(const Camera& camera, double aspectRatio);

// The rays of a camera for an image of the given width / height.
class CameraRays {
 public:
  CameraRays(const Camera& camera, float aspectRatio);

  // The ray through an image point (u right, v down, both in [0, 1]). The direction is unit.
  void ray(float u, float v, vec3& origin, vec3& direction) const {
    const vec3 point = pointAt(u, v);
    origin = orthographic_ ? position_ + point : position_;
    direction = orthographic_ ? forward_ : glm::normalize(point);
  }

  // The directions of rays, in lanes (math/lanes.h), of a pinhole that does not distort; all begin
  // at origin().
  bool isPlain() const { return !orthographic_ && !hasLens() && !distorts_; }
  const vec3& origin() const { return position_; }
  template <class F>
  Lanes3<F> directions(F u, F v) const {
    const auto along = [&](int i) { return corner_[i] + u * across_[i] + v * down_[i]; };
    return normalized(Lanes3<F>{along(0), along(1), along(2)});
  }

  // The ray from a point of the thin lens to the same point of the plane in focus. `lens` in
  // [0, 1)^2 is mapped uniformly to the area of the lens.
  bool hasLens() const { return lensRadius_ > 0; }
  void ray(float u, float v, vec2 lens, vec3& origin, vec3& direction) const;

  // The beam around the ray through an image point; `central`: from beamOf().
  Beam beamAt(const Beam& central, float u, float v) const;

  // Depth along the camera's axis, in metres, of the point `distance` metres along a ray.
  float depth(const vec3& direction, float distance) const {
    return distance * glm::dot(direction, forward_);
  }

 private:
  // The point at distance 1 along the axis that the image shows at (u, v), relative to the
  // position.
  vec3 pointAt(float u, float v) const {
    const vec3 point = corner_ + u * across_ + v * down_;
    return distorts_ ? undistorted(point) : point;
  }
  vec3 undistorted(const vec3& point) const;

  bool orthographic_;
  vec3 position_, forward_;
  // The rectangle at distance 1 that a pinhole would show, relative to the position.
  vec3 corner_, across_, down_;
  vec3 right_, up_;
  float lensRadius_, focus_;
  bool distorts_;
  Distortion distortion_;
};

// The rays of a camera that moves while the shutter is open.

// Between two keys (scene/motion.h) the position moves along a straight line, and the frame turns
// about one axis at constant speed.
class MovingCamera {
 public:
  // `aspectRatio`: the image's width / height. The camera must have a motion.
  MovingCamera(const Camera& camera, float aspectRatio);

  Camera cameraAt(float time) const;  // stands still
  CameraRays at(float time) const { return {cameraAt(time), aspectRatio_}; }

 private:
  struct Key {
    vec3 position;
    glm::quat frame;  // turns the axes to right, up and back
    float fov, halfHeight;
  };
  Camera lens_;  // properties that do not move
  float aspectRatio_;
  std::vector<Key> keys_;
};

// Projects points onto a camera's image: the inverse of CameraRays.

class CameraView {
 public:
  CameraView(const Camera& camera, double aspectRatio);

  // The image position (u right, v down; the image is [0, 1]^2) and the depth in metres along the
  // camera's axis; nullopt behind a perspective camera, and where the lens's picture has folded
  // back (Distortion::fold).
  struct Point {
    glm::dvec2 position;
    double depth;
  };
  std::optional<Point> at(const glm::dvec3& point) const;

 private:
  bool orthographic_;
  glm::dvec3 position_;
  glm::dmat3 toCamera_;
  glm::dvec2 axis_, scale_;  // image position of the axis; image sizes per metre at depth 1
  Distortion distortion_;
  double fold_;
};

// An image projected from a camera onto the surfaces that are visible to it.

class Projection {
 public:
  // A projection to images of width x height pixels; initially no surface is visible.
  Projection(const Camera& camera, int width, int height);

  // Sets the maximum depth of the surface visible in each pixel, in metres along the camera's axis;
  // 0: none (one channel). Applies a maximum filter over the neighbouring pixels, because samples
  // underestimate the maximum depth of an oblique surface.
  void setDepth(const Image& farthest);

  // The colour of the pixel that contains `point`; nullopt if the point is outside the image or
  // occluded.
  std::optional<Rgb> lookup(const vec3& point) const;

  Image& colors() { return colors_; }
  const Image& colors() const { return colors_; }
  bool sees(int x, int y) const { return *depth_.at(x, y) > 0; }

 private:
  CameraView view_;
  Image colors_, depth_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Chooses a camera for a scene without one.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace chromeball {

// What is given of the view; the rest is chosen.
struct ViewWishes {
  std::optional<ViewAngles> angles;
  std::optional<double> fov;        // vertical, radians
  std::optional<std::string> node;  // to be framed, with its descendants, in place of all
  bool turns = false;               // the camera or the model, around the centre
  bool onTurntable = false;         // whose axis runs through centreOf() all

  bool operator==(const ViewWishes&) const = default;
};

// A camera that frames a scene from outside, as close as possible with all vertices in view and a
// small margin, or one that sees a room from inside, unless angles or a node are given, or the
// camera turns. What is not given suits the shape (scene/choose_view.h).
//
// Ground planes are not framed. These are flat instances (at least twenty times as wide as high)
// below all others, beyond whose bounds they extend by more than the width of these.
class Framing {
 public:
  // `aspectRatio`: width / height. A scene without extent is seen from a fixed distance.
  Framing(const Scene& scene, float aspectRatio, const ViewWishes& wishes = {});

  // The same scene at another time, which shall be in view too.
  void add(const Scene& later);

  Camera camera() const;

  // What the camera looks at, if it or the model turns.
  vec3 centre() const { return vec3(centre_); }

  // Whether a probe lights nothing that the camera sees: all walls are single-sided and face
  // inwards, so that they block its light.
  bool isDark() const { return isDark_; }

 private:
  // The extremes of x + z slope and -x + z slope over all vertices.
  struct AxisFit {
    double slope;
    double upper = -INFINITY, lower = -INFINITY;

    void add(double x, double z);
    void add(const AxisFit& other);
    double position() const { return 0.5 * (upper - lower); }
    double distance() const { return 0.5 * (upper + lower) / slope; }
  };
  struct Extent {
    AxisFit across, upwards;
    double squaredRadius = 0;  // around the centre
  };

  ViewWishes wishes_;
  Camera view_;  // its frame and field of view; inside a room also its place
  bool isInside_ = false, isDark_ = false;
  glm::dvec3 centre_{0};
  double slope_;  // of the view's upper edge, less a margin
  float aspectRatio_;
  Extent extent_;
};

Camera framingCamera(const Scene& scene, float aspectRatio, const ViewWishes& wishes = {});

// The centre of the bounds that are framed; 0 for a scene without triangles.
vec3 centreOf(const Scene& scene);

// The instances of the nodes with this name and of their descendants: indices into scene.instances.
std::vector<int> instancesBelow(const Scene& scene, const std::string& node);

}  // namespace chromeball

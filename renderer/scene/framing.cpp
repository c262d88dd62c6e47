// SPDX-License-Identifier: Apache-2.0
#include "scene/framing.h"

#include "base/parallel.h"
#include "scene/bounds.h"
#include "scene/choose_view.h"

namespace chromeball {
namespace {

constexpr double kFov = 47 * kPiD / 180;
constexpr double kMargin = 1.05;

bool isFlat(const Bounds& box) {
  constexpr float kFlat = 20;
  const vec3 size = box.max - box.min;
  return std::max(size.x, size.z) > kFlat * size.y;
}

bool reachesBeyond(const Bounds& box, const Bounds& others) {
  const vec3 size = others.max - others.min;
  const float maximum = std::max(size.x, size.z);
  return box.min.x < others.min.x - maximum || box.max.x > others.max.x + maximum ||
         box.min.z < others.min.z - maximum || box.max.z > others.max.z + maximum;
}

bool isBelow(const Bounds& box, const Bounds& others) {
  return box.min.y + box.max.y < others.min.y + others.max.y;
}

// The instances to frame: all except ground planes.
std::vector<int> withoutGrounds(const Scene& scene) {
  std::vector<Bounds> boxes;
  Bounds upright;
  for (const Instance& instance : scene.instances) {
    boxes.push_back(bounds(scene, instance));
    if (!isFlat(boxes.back())) upright.add(boxes.back());
  }
  std::vector<int> chosen;
  for (size_t i = 0; i < boxes.size(); ++i)
    if (upright.empty() || !isFlat(boxes[i]) || !isBelow(boxes[i], upright) ||
        !reachesBeyond(boxes[i], upright))
      chosen.push_back(int(i));
  return chosen;
}

std::vector<int> subjects(const Scene& scene, const ViewWishes& wishes) {
  return wishes.node ? instancesBelow(scene, *wishes.node) : withoutGrounds(scene);
}

}  // namespace

// With the camera at `position` along an axis of the image and at `distance` from the centre, a
// vertex at x and z (towards the camera) is in view if
//   |x - position| <= (distance - z) slope,
// where `slope` is that of the view's edges. The extremes give the smallest distance for which this
// holds.
void Framing::AxisFit::add(double x, double z) {
  upper = std::max(upper, x + z * slope);
  lower = std::max(lower, -x + z * slope);
}

void Framing::AxisFit::add(const AxisFit& other) {
  upper = std::max(upper, other.upper);
  lower = std::max(lower, other.lower);
}

Framing::Framing(const Scene& scene, float aspectRatio, const ViewWishes& wishes)
    : wishes_(wishes), aspectRatio_(aspectRatio) {
  const std::vector<int> framed = subjects(scene, wishes);
  const Bounds box = bounds(scene, framed);
  if (!box.empty()) centre_ = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  if (wishes.node && wishes.onTurntable) {  // which carries the node around the axis
    const glm::dvec3 axis(centreOf(scene));
    centre_ = {axis.x, centre_.y, axis.z};
  }
  const ChosenView chosen = chooseView(scene, framed);
  isDark_ = chosen.isDark || (wishes.node && areShutIn(scene, framed, withoutGrounds(scene)));
  isInside_ = chosen.inside && !wishes.angles && !wishes.node && !wishes.turns;
  if (isInside_)
    view_ = *chosen.inside;
  else
    wishes.angles.value_or(chosen.outside).orient(view_), view_.fov = float(kFov);
  if (wishes.fov) view_.fov = float(*wishes.fov);
  slope_ = std::tan(0.5 * double(view_.fov)) / kMargin;
  extent_ = {{slope_ * aspectRatio}, {slope_}};
  add(scene);
}

void Framing::add(const Scene& later) {
  if (isInside_) return;
  const glm::dvec3 right(view_.right), up(view_.up), back(view_.back);
  for (const int i : subjects(later, wishes_)) {
    const Instance& instance = later.instances[size_t(i)];
    const std::vector<vec3>& positions = later.meshes[size_t(instance.mesh)].positions;
    const auto addVertices = [&](size_t begin, size_t end, Extent& part) {
      for (size_t k = begin; k < end; ++k) {
        const glm::dvec3 p = glm::dvec3(instance.point(positions[k])) - centre_;
        const double z = glm::dot(p, back);
        part.across.add(glm::dot(p, right), z);
        part.upwards.add(glm::dot(p, up), z);
        part.squaredRadius = std::max(part.squaredRadius, glm::dot(p, p));
      }
    };
    extent_ = joinRanges(positions.size(), kElementsOfTask, extent_, addVertices,
                         [](Extent& to, const Extent& other) {
                           to.across.add(other.across);
                           to.upwards.add(other.upwards);
                           to.squaredRadius = std::max(to.squaredRadius, other.squaredRadius);
                         });
  }
}

Camera Framing::camera() const {
  if (isInside_) return view_;
  Camera camera = view_;
  const glm::dvec3 right(camera.right), up(camera.up), back(camera.back);
  const double radius = std::sqrt(extent_.squaredRadius);
  // A scene without extent gets a view of about a metre, or wider if rounding errors of coordinates
  // far from the origin require it.
  if (2 * radius <= 1e-6 * glm::length(centre_)) {
    camera.position = vec3(centre_ + (2 + 1e-3 * glm::length(centre_)) * back);
  } else if (wishes_.turns) {
    // The sphere around all touches the narrower pair of the view's planes.
    const double slope = slope_ * std::min(1.0, double(aspectRatio_));
    camera.position = vec3(centre_ + radius * std::sqrt(1 + 1 / (slope * slope)) * back);
  } else {
    const double distance = std::max(extent_.across.distance(), extent_.upwards.distance());
    camera.position = vec3(centre_ + extent_.across.position() * right +
                           extent_.upwards.position() * up + distance * back);
  }
  return camera;
}

Camera framingCamera(const Scene& scene, float aspectRatio, const ViewWishes& wishes) {
  return Framing(scene, aspectRatio, wishes).camera();
}

vec3 centreOf(const Scene& scene) {
  const Bounds box = bounds(scene, withoutGrounds(scene));
  return box.empty() ? vec3(0) : 0.5f * box.min + 0.5f * box.max;
}

std::vector<int> instancesBelow(const Scene& scene, const std::string& node) {
  std::vector<int> found;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    int at = scene.instances[i].node;
    while (at >= 0 && scene.nodeNames[size_t(at)] != node)
      at = scene.nodeParents.empty() ? -1 : scene.nodeParents[size_t(at)];
    if (at >= 0) found.push_back(int(i));
  }
  return found;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "scene/choose_view.h"

#include <algorithm>

#include "scene/placed_triangles.h"

namespace chromeball {
namespace {

using glm::dvec3;

constexpr ViewAngles kUsual{24.2277, 17.6983};  // from (0.45, 0.35, 1)

ViewAngles anglesOf(const dvec3& direction) {
  return {glm::degrees(std::atan2(direction.x, direction.z)),
          glm::degrees(std::asin(std::clamp(direction.y / glm::length(direction), -1.0, 1.0)))};
}

// The sum of the triangles' vectors of area, which point to their fronts, and of their areas.
struct Areas {
  dvec3 vector{0};
  double sum = 0;
};

Areas areasOf(const Scene& scene, const std::vector<int>& instances) {
  Areas areas;
  forShownTriangles(scene, instances, [&](const Corners& c, int) {
    const dvec3 area = glm::cross(c[1] - c[0], c[2] - c[0]);
    areas.vector += area, areas.sum += glm::length(area);
  });
  return areas;
}

// The angles for a shape with a front, and for one that is long; nullopt for any other.
std::optional<ViewAngles> anglesForShape(const Areas& areas, const dvec3& size) {
  // Charts with legible faces, which glTF turns towards +Z, may be thicker than other flat shapes.
  constexpr double kPlane = 0.999, kThin = 0.12, kThinChart = 0.21, kLong = 1.5;
  const dvec3& front = areas.vector;
  if (glm::length(front) > kPlane * areas.sum && areas.sum > 0) return anglesOf(front);
  if (size.x < kThin * std::min(size.y, size.z)) return ViewAngles{front.x < 0 ? -90.0 : 90.0, 0};
  if (size.z < kThinChart * std::min(size.x, size.y))
    return ViewAngles{front.z < 0 ? 180.0 : 0.0, 0};
  if (size.y < kThin * std::min(size.x, size.z)) return ViewAngles{kUsual.azimuth, 45};
  if (size.z > kLong * size.x) return ViewAngles{90 - kUsual.azimuth, kUsual.elevation};
  return {};
}

// The way into a box through its open sides; nullopt if it is no such box. From above unless it is
// closed there.
std::optional<ViewAngles> anglesIntoBox(const Scene& scene, const std::vector<int>& instances,
                                        const Bounds& box, const OutsideViews& outside) {
  constexpr double kMinWalls = 0.6;  // of what is seen from the middle
  const dvec3 middle = 0.5 * (dvec3(box.min) + dvec3(box.max));
  const std::vector<Sight> sights = sightsFrom(scene, instances, middle);
  const auto walls = double(std::ranges::count_if(sights, &Sight::isWall));
  if (walls < kMinWalls * double(sights.size())) return {};
  const std::optional<dvec3> open = openSides(sights, middle, box, outside);
  if (!open || *open == dvec3(0)) return {};
  const bool isClosedAbove = !outside[1].shows(middle, true);
  return ViewAngles{anglesOf(*open).azimuth, isClosedAbove ? 0 : kUsual.elevation};
}

// Whether light comes in through windows or an opening.
bool seesOut(const std::vector<Sight>& sights) {
  constexpr double kMostOpen = 0.01;
  const auto isOut = [](const Sight& s) { return s.distance == INFINITY; };
  return double(std::ranges::count_if(sights, isOut)) > kMostOpen * double(sights.size());
}

}  // namespace

ChosenView chooseView(const Scene& scene, const std::vector<int>& instances) {
  ChosenView view{.outside = kUsual};
  const Bounds box = bounds(scene, instances);
  if (box.empty()) return view;
  if (const auto angles = anglesForShape(areasOf(scene, instances), box.size()))
    view.outside = *angles;
  if (!(glm::min(box.size().x, glm::min(box.size().y, box.size().z)) > 0)) return view;
  const OutsideViews outside = outsideViews(scene, instances, box);
  const bool hidesBacks = facesOf(outside).hideBacks();
  if (const auto interior = interiorView(scene, instances, box, outside)) {
    view.inside = interior->camera;
    view.isDark = hidesBacks && !seesOut(interior->sights);
    return view;
  }
  if (const auto angles = anglesIntoBox(scene, instances, box, outside))
    view.outside = *angles;
  else
    view.isDark = hidesBacks;
  return view;
}

bool areShutIn(const Scene& scene, const std::vector<int>& instances, std::vector<int> all) {
  std::erase_if(all, [&](int i) { return std::ranges::binary_search(instances, i); });
  const Bounds around = bounds(scene, all), box = bounds(scene, instances);
  if (around.empty() || box.empty()) return false;
  if (!(glm::min(around.size().x, glm::min(around.size().y, around.size().z)) > 0)) return false;
  const dvec3 middle = 0.5 * (dvec3(box.min) + dvec3(box.max));
  return !seesOut(sightsFrom(scene, all, middle)) &&
         facesOf(outsideViews(scene, all, around)).hideBacks();
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "turned.h"

#include <algorithm>
#include <cmath>

namespace chromeball::demo {

Profile filleted(const Profile& corners, double radius, double longest) {
  constexpr int kSteps = 6;
  Profile profile = {corners.front()};
  const auto straightTo = [&](dvec2 end) {
    const dvec2 start = profile.back();
    const int pieces = std::max(1, int(std::ceil(glm::length(end - start) / longest)));
    for (int k = 1; k <= pieces; ++k) profile.push_back(glm::mix(start, end, double(k) / pieces));
  };
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const dvec2 before = corners[i - 1] - corners[i], after = corners[i + 1] - corners[i];
    const dvec2 a = corners[i] + before * std::min(radius / glm::length(before), 0.49);
    const dvec2 b = corners[i] + after * std::min(radius / glm::length(after), 0.49);
    straightTo(a);
    for (int k = 1; k <= kSteps; ++k) {  // Bezier's parabola of a, the corner and b
      const double t = double(k) / kSteps;
      profile.push_back(glm::mix(glm::mix(a, corners[i], t), glm::mix(corners[i], b, t), t));
    }
  }
  straightTo(corners.back());
  return profile;
}

Parametrisation turned(dvec3 foot, const Profile& profile) {
  return lathe(foot, [profile](double v) {
    const double s = v * double(profile.size() - 1);
    const size_t i = size_t(std::clamp(s, 0.0, double(profile.size() - 2)));
    return glm::mix(profile[i], profile[i + 1], s - double(i));
  });
}

Surface tessellateTurned(int columns, dvec3 foot, const Profile& profile) {
  return tessellate(columns, int(profile.size()) - 1, turned(foot, profile), Uvs::Parameters);
}

Parametrisation torus(dvec3 center, double radius, double tube) {
  return lathe(center, [=](double v) {
    const double angle = 2 * kPiD * v;
    return dvec2(radius - tube * std::cos(angle), -tube * std::sin(angle));
  });
}

}  // namespace chromeball::demo

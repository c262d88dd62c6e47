// SPDX-License-Identifier: Apache-2.0
#include "scene/light.h"

#include "scene/motion.h"

namespace chromeball {

// A spot's falloff is 1 within the inner cone and ((cos - cosOuter) / (cosInner - cosOuter))^2
// between the cones, whose cosines are 1 - innerCone and 1 - outerCone.
float PunctualLight::intensityOfOneWatt() const {
  if (kind == Kind::Point) return 1 / (4 * kPi);
  return 1 / (2 * kPi * (innerCone + (outerCone - innerCone) / 3));
}

LampPose PunctualLight::poseAt(float time) const {
  if (!motion) return {position, direction};
  const KeySpan span = keysAround(motion->size(), time);
  const LampPose &from = (*motion)[span.from], &to = (*motion)[span.to];
  return {glm::mix(from.position, to.position, span.fraction),
          glm::normalize(glm::mix(from.direction, to.direction, span.fraction))};
}

}  // namespace chromeball

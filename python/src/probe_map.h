// SPDX-License-Identifier: Apache-2.0
// A probe in memory: a map that several probes may share, turned and scaled.
#pragma once

#include <memory>
#include <string>

#include "base/message.h"
#include "image/image.h"
#include "math/rotation.h"
#include "probe/probe.h"

namespace chromeball::python {

struct ProbeMap {
  std::shared_ptr<const Image> map;  // lat-long, finite, not negative
  Rotation rotation;
  glm::dvec3 scale{1};
  std::string name;     // of its file, or "the array"
  std::string mapping;  // of the file or array
  Messages messages;    // of its reader
};

// The turn that is `own`, and then `turn`.
inline Rotation after(const Rotation& own, const Rotation& turn) {
  if (!own.isTilted() && !turn.isTilted()) return Rotation(own.yaw() + turn.yaw());
  return Rotation::ofQuaternion(turn.quaternion() * own.quaternion());
}

}  // namespace chromeball::python

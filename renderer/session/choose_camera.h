// SPDX-License-Identifier: Apache-2.0
// The camera of a job: the scene file's, the model's, or one that frames the model.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace chromeball {

struct RenderDescription;

// What depends on the models' bounds, at time 0 of an animation, so that it is the same at all
// times.
struct AutomaticView {
  std::optional<Camera> camera;  // if nobody has placed one
  vec3 centre{0};                // of the camera's turn; 0 without one
  glm::dvec3 origin{0};          // of these coordinates in the world, metres

  AutomaticView seenFrom(const glm::dvec3& other) const;  // with another origin
};

// The job's size must be final.
AutomaticView automaticView(const RenderDescription& job, const Scene& scene,
                            const glm::dvec3& origin);

// Before its `orbit`. Throws InputError for a camera that the model does not have, or a lens of an
// orthographic one.
Camera chooseCamera(const RenderDescription& job, const Scene& scene, const AutomaticView& view);

}  // namespace chromeball

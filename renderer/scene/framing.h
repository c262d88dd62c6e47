// SPDX-License-Identifier: Apache-2.0
// Chooses a camera for a scene without one.
#pragma once

#include "scene/scene.h"

namespace chromeball {

// A camera that frames the scene from the front, slightly above and to the right: as close as
// possible with all vertices in view and a small margin. `aspectRatio`: width / height. A scene
// without extent is seen from a fixed distance, a room from inside (interior_view.h).
//
// Ground planes are not framed. These are flat instances (at least twenty times as wide as high)
// that extend beyond the bounds of all other instances by more than the width of those bounds.
Camera framingCamera(const Scene& scene, float aspectRatio);

// A camera that sees the scene from the same direction, and can turn around its centre with all
// vertices in view.
Camera framingCameraAround(const Scene& scene, float aspectRatio);

// The centre of the bounds of what framingCamera() frames; 0 for a scene without triangles.
vec3 centreOf(const Scene& scene);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A view of a scene that brings no camera of its own.
#pragma once

#include "scene/scene.h"

namespace chromeball {

// A camera that frames the scene from the front, slightly above and to the right: as close as the
// vertices allow, with a small margin. `aspectRatio`: width / height. A scene without extent is
// seen from some distance; a room is seen from inside (interior_view.h).
//
// Grounds are not framed: instances that are flat (twenty times as wide as high) and reach farther
// beyond the bounds of those that are not than these are wide.
Camera framingCamera(const Scene& scene, float aspectRatio);

}  // namespace chromeball

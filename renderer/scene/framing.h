// A view of a scene that brings no camera of its own.
#pragma once

#include "scene/scene.h"

namespace chromeball {

// A camera that frames the scene from the front, slightly above and to the right: as close as the
// vertices allow, with a small margin. `aspectRatio`: width / height. A scene without extent is
// seen from some distance.
Camera framingCamera(const Scene& scene, float aspectRatio);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Chooses a camera for a scene without one.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace chromeball {

// A camera that frames the scene from the front, slightly above and to the right: as close as
// possible with all vertices in view and a small margin. `aspectRatio`: width / height. A scene
// without extent is seen from a fixed distance, a room from inside.
//
// Ground planes are not framed. These are flat instances (at least twenty times as wide as high)
// that extend beyond the bounds of all other instances by more than the width of those bounds.
Camera framingCamera(const Scene& scene, float aspectRatio);

// A camera that sees the scene from the same direction, and can turn around its centre with all
// vertices in view.
Camera framingCameraAround(const Scene& scene, float aspectRatio);

// The centre of the bounds that framingCamera() frames; 0 for a scene without triangles.
vec3 centreOf(const Scene& scene);

// A camera inside the room that the instances form (indices into scene.instances); nullopt if they
// do not form a room. They do if front faces of walls surround some free position on all sides
// except for a window or a door, floor and furniture are below it, none of the four sides of the
// model is open, and one of these holds:
// - Seen from the six sides of the bounding box, 60% of the nearest surfaces are back faces:
//   single-sided walls that face inwards.
// - The bounding box is 2 to 10 metres high and at least 2.5 metres wide, and there are at least
//   five instances: furniture within walls with two faces. (Size and count exclude cups, whose
//   walls also surround a free position.)
// The camera is at 55% of the room's height, at the position and in the direction from which it
// sees the largest area of a horizontal section through the room. O(triangles).
std::optional<Camera> interiorView(const Scene& scene, const std::vector<int>& instances);

}  // namespace chromeball

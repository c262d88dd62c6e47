// SPDX-License-Identifier: Apache-2.0
// Chooses a camera inside a room.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace chromeball {

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

// SPDX-License-Identifier: Apache-2.0
// A view of a room from inside, for a scene that shows its back to whoever stands outside.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace chromeball {

// A camera inside the room that the instances make (indices into scene.instances); nullopt where
// they make none. They do where the fronts of walls surround a free place on all sides, but for a
// window or a door, and
// - from the six sides of their bounds, 60% of the surfaces that are met first are met from behind:
//   single-sided walls that face inwards; or
// - the bounds are 2 to 10 metres high and at least 2.5 wide, and there are five instances or more:
//   furniture within walls of two faces. (A cup's walls surround a free place as well.)
// The camera stands a little above half the room's height and looks where it sees the largest part
// of a horizontal section through the room. O(triangles).
std::optional<Camera> interiorView(const Scene& scene, const std::vector<int>& instances);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What is seen of a building from outside.
#pragma once

#include <vector>

#include "scene/bounds.h"

namespace chromeball {

// Whether most surfaces of the instances (indices into scene.instances) that are seen from the six
// sides of their bounding box are back faces: those of single-sided walls that face inwards. The
// box has an extent along each axis. O(triangles), on all threads.
bool facesInwards(const Scene& scene, const std::vector<int>& instances, const Bounds& box);

}  // namespace chromeball

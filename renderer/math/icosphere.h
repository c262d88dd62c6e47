// SPDX-License-Identifier: Apache-2.0
// Directions spread evenly over the sphere.
#pragma once

#include <vector>

#include "math/vec.h"

namespace chromeball {

// The unit normals of the 20 * 4^subdivisions faces of an icosahedron, each of whose triangles was
// cut in four at the middles of its edges, pushed out to the sphere, `subdivisions` times. Five
// give the 20480 normals of Madsen and Laursen 2007. The set is its own mirror image in the origin.
std::vector<vec3> icosphereNormals(int subdivisions);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Directions spread evenly over the sphere.
#pragma once

#include <vector>

#include "math/vec.h"

namespace chromeball {

// The unit normals of the 20 * 4^subdivisions faces of a subdivided icosahedron: each step splits
// every triangle into four at the midpoints of its edges and projects these onto the sphere. Five
// steps give the 20480 normals of Madsen and Laursen 2007. With each normal the set contains its
// opposite.
std::vector<vec3> icosphereNormals(int subdivisions);

// The index in icosphereNormals() of the face that `direction` (of any length but 0) goes through;
// on an edge, of one beside it.
int icosphereFace(const vec3& direction, int subdivisions);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Solids of revolution with profiles of corners, as a lathe makes them.
#pragma once

#include "shapes.h"

namespace chromeball::demo {

// (radius, height) of the corners of a profile.
using Profile = std::vector<dvec2>;

// The same with each inner corner rounded by a parabolic arc that starts `radius` before it, and
// with straight parts cut into pieces no longer than `longest`.
Profile filleted(const Profile& corners, double radius, double longest = INFINITY);

// The profile turned about the vertical through `foot`. It runs up the outside: from the axis below
// to the axis above makes a closed body.
Parametrisation turned(dvec3 foot, const Profile& profile);
Surface tessellateTurned(int columns, dvec3 foot, const Profile& profile);

// A ring that lies flat: the tube's radius is `tube`, its axis is `radius` from the centre.
Parametrisation torus(dvec3 center, double radius, double tube);

}  // namespace chromeball::demo

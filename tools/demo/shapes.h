// SPDX-License-Identifier: Apache-2.0
// The surfaces of the demo's still life.
#pragma once

#include <functional>
#include <vector>

#include "math/vec.h"

namespace chromeball::demo {

using glm::dvec2;
using glm::dvec3;

inline constexpr double kTableRadius = 2.3;

struct Surface {
  std::vector<vec3> positions, normals;
  std::vector<vec2> uvs;
  std::vector<glm::uvec3> triangles;
};

// The point of a surface at (u, v) in [0, 1]^2. u runs counter-clockwise seen from above, v
// upwards, so that dp/du x dp/dv points out.
using Parametrisation = std::function<dvec3(double u, double v)>;

// The extent of a texture: the table's square of x and z, or [0, 1]^2 of u and v.
enum class Uvs { Table, Parameters };

// Smooth; 2 * columns * rows triangles, less the triangles that a pole makes degenerate.
Surface tessellate(int columns, int rows, const Parametrisation& point, Uvs uvs = Uvs::Table);

void append(Surface& surface, const Surface& more);

// A profile (radius, height) turned about the axis x = center.x, z = center.z. It points out where
// the profile rises outside, and down where its radius grows.
Parametrisation lathe(dvec3 center, const std::function<dvec2(double v)>& profile);

// The parallelogram at `corner` with the edges `right` and `up`; faces along right x up.
Parametrisation patch(dvec3 corner, dvec3 right, dvec3 up);

Parametrisation ball(dvec3 center, double radius);

// A disc of radius kTableRadius with a rounded edge, its top at y = 0:
// (radius/R)^16 + (height/h)^16 = 1.
Parametrisation tableTop();

// A profile up the outside, over the lip and down the inside.
Parametrisation vase(dvec3 foot);

// A tube along the (2, 3) torus knot, standing upright, turned about its vertical (radians).
Parametrisation knot(dvec3 center, double size, double tube, double turn);

// |x|^6 + |y|^6 + |z|^6 = radius^6: a cube with soft edges, turned about its vertical (radians).
Parametrisation softCube(dvec3 center, double radius, double turn);

}  // namespace chromeball::demo

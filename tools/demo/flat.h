// SPDX-License-Identifier: Apache-2.0
// Surfaces of flat faces: boxes, and walls with an arched opening.
#pragma once

#include <span>

#include "shapes.h"

namespace chromeball::demo {

// A convex polygon, counter-clockwise seen from its front.
void addPolygon(Surface& surface, std::span<const vec3> corners, float textureSize);

// The parallelogram of a and b, facing along cross(a, b). A texture lies upright on it, and covers
// `textureSize` metres, everywhere in step with the world's coordinates.
void addQuad(Surface& surface, vec3 corner, vec3 a, vec3 b, float textureSize);

// A convex section of x and y, counter-clockwise, drawn from z.x to z.y; closed.
void addPrism(Surface& surface, std::span<const vec2> section, vec2 z, float textureSize);

// A box without its bottom, and a closed one.
void addBox(Surface& surface, vec3 low, vec3 high, float textureSize);
void addClosedBox(Surface& surface, vec3 low, vec3 high, float textureSize);

// A wall that starts at `corner` and has the horizontal edge `along`; its front faces along
// cross(along, y), its back is `thickness` behind.
struct Wall {
  vec3 corner, along;
  float height, thickness;
};

// An opening in the middle of a wall: straight up to `spring`, above it half a circle. Heights are
// above the wall's lower edge; a sill of 0 is a passage.
struct Opening {
  float halfWidth, sill, spring;
};

// Front, back, and the faces within the opening; the ends and the upper edge are open.
void addWall(Surface& surface, const Wall& wall, const Opening& opening, float textureSize);

}  // namespace chromeball::demo

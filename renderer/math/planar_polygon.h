// SPDX-License-Identifier: Apache-2.0
// Simple polygons in the plane.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "math/vec.h"

namespace chromeball {

using glm::dvec2;

double signedArea(std::span<const dvec2> polygon);  // positive if counter-clockwise

// Why the polygon is not simple; nullopt if it is: at least three vertices, an area, no edges that
// touch other than neighbours at their vertex. Takes time in proportion to the square of their
// number.
std::optional<std::string_view> whyNotSimple(std::span<const dvec2> polygon);

// By the even-odd rule; points on edges belong to either side.
bool contains(std::span<const dvec2> polygon, const dvec2& point);

// Indices of the vertices of triangles that together cover a simple counter-clockwise polygon (ear
// clipping).
std::vector<std::array<size_t, 3>> triangulate(std::span<const dvec2> polygon);

// The convex hull, counter-clockwise, without vertices on its edges (Andrew 1979).
std::vector<dvec2> convexHull(std::vector<dvec2> points);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Work on a mesh's vertex arrays: mending what files leave out or state badly.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

// Makes vertex i a copy of the present vertex source[i], in every array the mesh has. Triangles are
// left alone.
void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& source);

// Drops the vertices that no triangle uses.
void dropUnusedVertices(Mesh& mesh);

// Gives every triangle three vertices of its own, with the triangle's normal.
void makeFlat(Mesh& mesh);

// Normals become unit; one that is zero or not finite is replaced by the area-weighted mean of the
// normals of the triangles around it. A mesh without normals is left so.
void mendNormals(Mesh& mesh);

// Tangents become unit and their w a sign; one that is zero or not finite becomes some direction
// perpendicular to the normal. Asks for normals.
void mendTangents(Mesh& mesh);

// Computes tangents from the coordinates a normal map is read with (one for each vertex). Asks for
// normals. Vertices whose triangles disagree in handedness are split.
void computeTangents(Mesh& mesh, std::vector<vec2> uv);

// Moves the mesh by an affine transform. Normals go by the inverse transpose; a mirror turns the
// triangles' winding and the tangents' sign, so that the front stays the front.
void transformMesh(Mesh& mesh, const glm::dmat4& transform);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Repairs and completes the vertex arrays of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

bool areFinite(const std::vector<vec3>& points);

// Replaces all vertex arrays: the new vertex i is a copy of the old vertex source[i]. Does not
// change the triangles.
void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& source);

// Drops the vertices that no triangle uses.
void dropUnusedVertices(Mesh& mesh);

// Gives every triangle its own three vertices, with the triangle's normal.
void makeFlat(Mesh& mesh);

// Normalises the normals. One that is zero or not finite becomes the area-weighted mean of the
// normals of the triangles around its vertex. Does nothing if the mesh has no normals.
void repairNormals(Mesh& mesh);

// Normalises the tangents and makes w a sign. One that is zero or not finite becomes an arbitrary
// direction perpendicular to the normal. Precondition: the mesh has normals.
void repairTangents(Mesh& mesh);

// Computes tangents from the UV coordinates of the normal map, one for each vertex. Splits vertices
// whose triangles turn opposite ways in UV space; all poses of a mesh are split alike.
// Precondition: the mesh has normals.
void computeTangents(Mesh& mesh, const std::vector<vec2>& uv);

// Applies an affine transform, which may flatten the mesh. Normals are transformed by
// normalMatrix() (transform.h). If the transform mirrors, the winding of the triangles and the
// sign of the tangents are inverted, so that front faces stay front faces.
void transformMesh(Mesh& mesh, const glm::dmat4& transform);

}  // namespace chromeball

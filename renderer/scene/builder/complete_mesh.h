// SPDX-License-Identifier: Apache-2.0
// Makes the arrays of a mesh sound, and adds what its material needs.
#pragma once

#include <string>
#include <vector>

#include "scene/material.h"
#include "scene/mesh.h"

namespace chromeball {

// The UV sets that the material's textures and tangents use, ascending.
std::vector<int> uvSetsOf(const Material& material);

// Throws InputError, begun by `location`, that names the array and the index of the error: vertex
// arrays of different lengths, numbers that are not finite, colours below 0, triangles of vertices
// that do not exist, UV sets of the material's textures that are missing.
void checkMesh(const Mesh& mesh, const Material& material, const std::string& location);

// A part of it: the lengths of the vertex arrays, and the vertices of the triangles.
void checkShape(const Mesh& mesh, const std::string& location);

// Repairs the normals and tangents of a mesh that checkMesh() accepts, drops vertices that no
// triangle uses, and colours that are all white, and computes the tangents that the material needs
// (flat normals too, for a normal map on a mesh that has none). Without UV coordinates, an
// anisotropic material gets tangents of any direction.
void completeMesh(Mesh& mesh, const Material& material);

}  // namespace chromeball

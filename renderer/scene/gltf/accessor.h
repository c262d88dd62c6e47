// SPDX-License-Identifier: Apache-2.0
// Reads glTF accessors: every component type, interleaved, normalised, sparse. Each byte offset,
// stride and count is checked before any byte is read. Errors throw InputError and name the user of
// the accessor (`where`).
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"
#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Calls visit(T()), with T the C++ type of an accessor's components.
template <class Visit>
auto withComponentType(int componentType, const Visit& visit) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return visit(int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return visit(uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return visit(int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return visit(uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return visit(uint32_t());
    default:
      return visit(float());
  }
}

// Elements of N components (1 to 4) as floats; integers are normalised if the accessor is.
// Throws if the accessor's type does not have N components.
template <int N>
std::vector<glm::vec<N, float>> readVectors(GltfFile& file, int accessor, const std::string& where);

// Vertex indices. Throws if one is the primitive-restart value or not below `vertexCount`.
std::vector<uint32_t> readIndices(GltfFile& file, int accessor, size_t vertexCount,
                                  const std::string& where);

// The same in groups of three; one or two left over are dropped.
std::vector<Triangle> readTriangles(GltfFile& file, int accessor, size_t vertexCount,
                                    const std::string& where);

std::vector<glm::dmat4> readMatrices(GltfFile& file, int accessor, const std::string& where);

// RGB (then alpha is 1) or RGBA.
std::vector<vec4> readColors(GltfFile& file, int accessor, const std::string& where);

}  // namespace chromeball

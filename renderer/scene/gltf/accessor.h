// SPDX-License-Identifier: Apache-2.0
// Reads glTF accessors: every component type, interleaved, normalised, sparse. Each byte offset,
// stride and count is checked before a byte is touched; what is wrong throws InputError naming the
// user of the accessor (`where`).
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"
#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Elements of N components as floats; integers as normalised values where the accessor says so.
// Throws where the accessor's type is not N components wide. N: 1 to 4.
template <int N>
std::vector<glm::vec<N, float>> readVectors(GltfFile& file, int accessor, const std::string& where);

// Vertex indices. Throws where one is the primitive-restart value or not below `vertexCount`.
std::vector<uint32_t> readIndices(GltfFile& file, int accessor, size_t vertexCount,
                                  const std::string& where);

std::vector<glm::dmat4> readMatrices(GltfFile& file, int accessor, const std::string& where);

// RGB or RGBA (alpha 1 where there is none).
std::vector<vec4> readColors(GltfFile& file, int accessor, const std::string& where);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression: primitives whose vertices and indices are one Draco mesh.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Decodes every Draco mesh that has no uncompressed stand-in, and points the accessors of its
// primitives at what was decoded. Throws InputError where the data is not well-formed or holds more
// than its accessors say.
void decodeDraco(GltfFile& file);

}  // namespace chromeball

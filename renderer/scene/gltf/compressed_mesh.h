// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression: primitives whose vertices and indices are stored as a Draco mesh.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Decodes every Draco mesh that has no uncompressed copy in the file, and points the accessors of
// its primitives to the decoded data. Throws InputError if the data is damaged or does not match
// its accessors.
void decodeDraco(GltfFile& file);

// EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are compressed.

// Replaces every compressed buffer view by one of the decoded bytes. Throws InputError if the
// compressed data or its description is invalid.
void decodeMeshopt(GltfFile& file);

}  // namespace chromeball

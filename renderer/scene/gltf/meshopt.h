// SPDX-License-Identifier: Apache-2.0
// EXT_meshopt_compression: buffer views whose bytes are compressed.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Replaces every compressed buffer view of the file by its decoded bytes. Throws InputError where
// the compressed data or what is said about it is not well-formed.
void decodeMeshopt(GltfFile& file);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are compressed.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Replaces every compressed buffer view by one of the decoded bytes. Throws InputError if the
// compressed data or its description is invalid.
void decodeMeshopt(GltfFile& file);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// KHR_materials_variants: alternative sets of materials for a model.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Gives each primitive its material in the variant. Warns of mappings to variants and materials
// that do not exist, and of a variant that no primitive uses. Throws InputError if the file has no
// such variant.
void applyVariant(GltfFile& file, const VariantChoice& choice);

}  // namespace chromeball

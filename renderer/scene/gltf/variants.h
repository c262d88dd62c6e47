// SPDX-License-Identifier: Apache-2.0
// KHR_materials_variants: one model in several dresses.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Gives each primitive the material that the variant has for it. Warns of mappings to variants and
// materials that do not exist, and of a variant that no primitive knows. Throws InputError where
// the file has no such variant.
void applyVariant(GltfFile& file, const VariantChoice& choice);

}  // namespace chromeball

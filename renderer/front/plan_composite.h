// SPDX-License-Identifier: Apache-2.0
// The composite of a description, from its settings.
#pragma once

#include "description/render_description.h"
#include "front/settings.h"

namespace chromeball {

// Reads the plate, whose size the image takes unless it has another. Throws InputError.
void planComposite(const Settings& settings, CompositeEntry entry, RenderDescription& description);

}  // namespace chromeball

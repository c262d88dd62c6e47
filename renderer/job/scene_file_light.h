// SPDX-License-Identifier: Apache-2.0
// The tables [[light]] of a scene file.
#pragma once

#include "job/toml_section.h"
#include "scene/lamp.h"

namespace chromeball {

// Reads one table. Throws InputError.
Lamp readLamp(const Entry& entry);

}  // namespace chromeball

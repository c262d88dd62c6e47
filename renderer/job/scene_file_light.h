// SPDX-License-Identifier: Apache-2.0
// The tables [[light]] of a scene file.
#pragma once

#include "job/toml_section.h"

namespace chromeball {

// One table. Throws InputError.
Lamp readLamp(const Entry& entry);

}  // namespace chromeball

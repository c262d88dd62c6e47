// The tables [[light]] of a scene file.
#pragma once

#include "scene/toml_section.h"

namespace chromeball {

// One table. Throws InputError.
Lamp readLamp(const Entry& entry);

}  // namespace chromeball

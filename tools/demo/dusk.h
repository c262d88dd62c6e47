// SPDX-License-Identifier: Apache-2.0
// The demo's light probe: a lake among hills at dusk, computed procedurally.
#pragma once

#include "image/image.h"

namespace chromeball::demo {

// A lat-long map, `width` x `width` / 2. Relative radiance; the low sun is a soft disc.
Image paintDusk(int width);

}  // namespace chromeball::demo

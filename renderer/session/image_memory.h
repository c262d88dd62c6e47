// SPDX-License-Identifier: Apache-2.0
// Estimates the memory of a render before it is allocated.
#pragma once

#include "base/memory.h"
#include "render/render.h"

namespace chromeball {

// The program, its libraries and its fixed tables; measured.
inline constexpr double kProcessBytes = 3e7;

// Peak memory of the film, the layers and the output images, in bytes.
double imageBytes(const RenderSettings& settings);

// What snapshots of a session take besides: the film again, and two images (live_image.h).
double snapshotBytes(const RenderSettings& settings);

}  // namespace chromeball

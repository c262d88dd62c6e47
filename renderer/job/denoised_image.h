// SPDX-License-Identifier: Apache-2.0
// The layers of a denoised image.
#pragma once

#include "denoise/denoise.h"
#include "image/io/write_image.h"

namespace chromeball {

// Replaces the color of `image` (not its alpha), and adds the layers `noisy` and `denoise_error`.
void addDenoised(Denoised denoised, Image noisy, OutputImage& image);

}  // namespace chromeball

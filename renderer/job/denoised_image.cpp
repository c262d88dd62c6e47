// SPDX-License-Identifier: Apache-2.0
#include "job/denoised_image.h"

namespace chromeball {

void addDenoised(Denoised denoised, Image noisy, OutputImage& image) {
  Image& color = image.layers.front().image;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) color.setRgb(x, y, denoised.color.rgb(x, y));
  image.layers.push_back({"noisy", "RGB", std::move(noisy)});
  image.layers.push_back({"denoise_error", "Y", std::move(denoised.error)});
}

}  // namespace chromeball

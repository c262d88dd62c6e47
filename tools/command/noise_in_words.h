// SPDX-License-Identifier: Apache-2.0
// The noise of an image as people read it.
#pragma once

#include <string>

#include "session/finish.h"

namespace chromeball {

// "0.4% in a typical pixel, above 14% in the worst 5%, mostly upper left".
std::string inWords(const NoiseFigures& noise, const Image& relativeErrors);

// The same of an image before denoising, "; denoised to about 0.2%, and 3.7% in the worst 5%", with
// the place of what remains.
std::string noiseInWords(const FinishedImage& image);

// The relative errors of the image as it is, denoised or not (measure/false_color.h), to a .png.
void writeNoiseMap(const std::string& path, const FinishedImage& image);

}  // namespace chromeball

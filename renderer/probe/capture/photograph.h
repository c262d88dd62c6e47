// SPDX-License-Identifier: Apache-2.0
// A photograph of a mirror ball, or through a fisheye lens.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/message.h"
#include "image/image.h"
#include "probe/capture/circle.h"

namespace chromeball {

// The linear colour of a file, three channels, finite and not negative.
struct LoadedPhotograph {
  Image image;
  Messages messages;  // of its reader and about it, each "FILE: ..."; often none
};
// Throws InputError.
LoadedPhotograph loadPhotograph(const std::filesystem::path& path);

// The weights of the pixels, one channel from 0 to 1: the brightest channel of an 8-bit image, as
// stored. `messages` gets the reader's. Throws InputError unless it has the size of `photograph`,
// read from `photographPath`.
Image loadMask(const std::filesystem::path& path, const Image& photograph,
               const std::filesystem::path& photographPath, Messages& messages);

// The disc of a photograph, as a function of position.
class PhotographDisc {
 public:
  // Keeps references to the images. `mask` is empty, or as from loadMask().
  PhotographDisc(const Image& image, const Circle& circle, const Image& mask);

  struct Sample {
    glm::dvec3 radiance;
    double coverage;  // the share of the interpolation inside image and mask; 0: no radiance
  };
  // The bilinear interpolation at a position in the disc of radius 1, x right and y up. It never
  // reads pixels that the rim may cut: points closer to the rim than 0.75 pixels have the radiance
  // at that distance.
  Sample at(const glm::dvec2& position) const;

 private:
  double weight(int x, int y) const;  // of a pixel

  const Image& image_;
  Circle circle_;
  const Image& mask_;
};

}  // namespace chromeball

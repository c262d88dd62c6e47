// SPDX-License-Identifier: Apache-2.0
// Reflectivity from a photograph that shows a surface twice: directly and in a mirror, or beside a
// standard (HDRI book, sections 9.3.1 and 9.3.5).
#pragma once

#include <string_view>

#include "image/image.h"

namespace chromeball {

struct PixelRectangle {
  int x, y, width, height;
};

// Parses "X,Y,WIDTH,HEIGHT" in whole pixels. Throws InputError, begun by `location`.
PixelRectangle parseRectangle(std::string_view text, std::string_view location);

struct PatchMean {
  glm::dvec3 mean;
  glm::dvec3 standardError;  // from the scatter of pixels, as if they were independent
  size_t pixels;
};

// The mean of linear values. Throws InputError, begun by `location`, if the rectangle reaches
// outside the image or has only one pixel, which has no standard error, or if a channel of it is
// negative, not finite, or at least `saturation`.
PatchMean patchMean(const Image& image, const PixelRectangle& rectangle, double saturation,
                    std::string_view location);

struct Reflectivity {
  glm::dvec3 value, standardError;
};

// standard x numerator / denominator. The relative errors add in squares. Throws InputError, begun
// by `location`, if the denominator is 0.
Reflectivity reflectivity(const PatchMean& numerator, const PatchMean& denominator,
                          const glm::dvec3& standard, std::string_view location);

}  // namespace chromeball

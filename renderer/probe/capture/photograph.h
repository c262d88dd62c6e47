// SPDX-License-Identifier: Apache-2.0
// A photograph of a mirror ball, or through a fisheye lens.
#pragma once

#include <filesystem>

#include "base/message.h"
#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// A circle in pixels, x right and y down from the top left corner of the image; texel (x, y) covers
// [x, x + 1) x [y, y + 1).
struct Circle {
  glm::dvec2 centre;
  double radius;
};

// The share of the circle's area that is inside an image of this size, to 1%.
double shareInside(const Circle& circle, int width, int height);

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

// The position from which a photograph of a ball was taken, as seen from the ball (or, for a lens,
// opposite to where it looks), in degrees: azimuth 0 is +Z, 90 is +X; elevation 90 is +Y. The
// camera stands upright: its right is horizontal.
struct CameraPosition {
  double azimuth = 0, elevation = 0;

  // The columns point to the camera's right, up, and from the ball to the camera.
  glm::dmat3 axes() const {
    const double a = azimuth * kPiD / 180, e = elevation * kPiD / 180;
    const glm::dvec3 right(std::cos(a), 0, -std::sin(a));
    const glm::dvec3 back(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
    return {right, glm::cross(back, right), back};
  }
};

}  // namespace chromeball

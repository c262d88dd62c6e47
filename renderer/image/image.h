// SPDX-License-Identifier: Apache-2.0
// A float image: row 0 on top, texel (x, y) covers [x, x+1) x [y, y+1).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// Channels are interleaved. The first three channels of a colour image are R, G, B.
struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> texels;

  Image() = default;
  Image(int w, int h, int c);  // of zeros

  bool empty() const { return texels.empty(); }
  size_t pixels() const { return size_t(width) * height; }
  size_t pixel(int x, int y) const { return size_t(y) * width + x; }  // row by row
  float* at(size_t pixel) { return &texels[pixel * channels]; }
  const float* at(size_t pixel) const { return &texels[pixel * channels]; }
  float* at(int x, int y) { return at(pixel(x, y)); }
  const float* at(int x, int y) const { return at(pixel(x, y)); }

  // Colour access. Precondition: at least three channels.
  Rgb rgb(size_t pixel) const {
    const float* t = at(pixel);
    return {t[0], t[1], t[2]};
  }
  void setRgb(size_t pixel, const Rgb& c) {
    float* t = at(pixel);
    t[0] = c.x, t[1] = c.y, t[2] = c.z;
  }
  Rgb rgb(int x, int y) const { return rgb(pixel(x, y)); }
  void setRgb(int x, int y, const Rgb& c) { setRgb(pixel(x, y), c); }
};

// The image of three channels with the colour of(x, y) at each texel.
template <class Color>
Image colorImage(int width, int height, const Color& of) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.setRgb(x, y, of(x, y));
  return image;
}

// Replaces the colour c of each texel by of(c).
template <class Color>
void recolor(Image& image, const Color& of) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image.setRgb(x, y, of(image.rgb(x, y)));
}

// Images of another size.

// Resampled with a box filter: each pixel is the mean of the area that it covers. An image of the
// requested size is returned unchanged.
Image resampled(const Image& image, int width, int height);

// The image as it is to be seen, from an image stored with this orientation (EXIF and TIFF, tag
// 274: 1 to 8; 6 is to be turned clockwise). Other numbers leave it unchanged.
Image oriented(Image stored, int orientation);

}  // namespace chromeball

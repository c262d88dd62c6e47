// SPDX-License-Identifier: Apache-2.0
// Edges of a picture.
#pragma once

#include <vector>

#include "image/image.h"

namespace chromeball {

// One channel: each pixel is the mean luminance of `scale` x `scale` pixels of the image; pixels
// left over on the right and below are left out.
Image meanLuminance(const Image& image, int scale);

// The natural logarithm of the luminance, which is raised to at least 1/1000 of its mean.
Image logarithm(Image luminance);

// Bilinear interpolation of one channel, continued beyond the rim.
double interpolate(const Image& channel, const glm::dvec2& position);

// A point of an edge: a pixel in which the gradient is larger than at its two neighbours along it.
struct EdgePoint {
  glm::dvec2 position;
  glm::dvec2 normal;  // unit, along the gradient
};

// Edges with the largest gradients: at most `share` of the pixels. Also the index of each pixel's
// edge point in `points`, or -1.
struct EdgeMap {
  int width = 0, height = 0;
  std::vector<EdgePoint> points;
  std::vector<int> index;

  EdgeMap(const Image& channel, double share);
  const EdgePoint* at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return nullptr;
    const int i = index[size_t(y) * width + x];
    return i < 0 ? nullptr : &points[size_t(i)];
  }
};

}  // namespace chromeball

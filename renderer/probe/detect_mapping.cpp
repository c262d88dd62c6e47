// SPDX-License-Identifier: Apache-2.0
#include "probe/detect_mapping.h"

#include <cmath>
#include <vector>

namespace chromeball {
namespace {

// Whether the image is black outside the mapping's valid area: at least 9 in 10 of those texels are
// below 1/1000 of the mean inside. (Debevec's probes have a copyright notice there.)
bool isBlackOutside(const Image& image, Mapping mapping) {
  double sumInside = 0;
  size_t countInside = 0;
  std::vector<float> outside;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float brightness = maxComponent(image.rgb(x, y));
      if (!std::isfinite(brightness)) continue;
      if (showsDirection(mapping, {(x + 0.5) / image.width, (y + 0.5) / image.height})) {
        sumInside += brightness;
        ++countInside;
      } else {
        outside.push_back(brightness);
      }
    }
  const double limit = 1e-3 * sumInside / double(std::max<size_t>(countInside, 1));
  size_t black = 0;
  for (const float brightness : outside) black += brightness <= limit;
  return 10 * black >= 9 * outside.size();
}

}  // namespace

DetectedMapping detectMapping(const Image& image) {
  const int w = image.width, h = image.height;
  if (w == 2 * h) return {Mapping::LatLong, "its shape is 2:1", true};
  if (w == 6 * h) return {Mapping::HorizontalStrip, "its shape is 6:1", true};
  if (h == 6 * w) return {Mapping::VerticalStrip, "its shape is 1:6", true};
  // Smaller images are too coarse to detect a disc, a cross or a grid of faces.
  constexpr int kMin = 12;
  if (h >= kMin && w == h)
    return isBlackOutside(image, Mapping::AngularMap)
               ? DetectedMapping{Mapping::AngularMap,
                                 "it is square and black outside the disc (so "
                                 "may be a mirror ball, which only its maker can tell)",
                                 true}
               : DetectedMapping{Mapping::MirrorBall, "it is square and not black outside the disc",
                                 false};
  if (h >= kMin && h % 4 == 0 && 3 * h == 4 * w)
    return {Mapping::VerticalCross, "its shape is 3:4",
            isBlackOutside(image, Mapping::VerticalCross)};
  if (h >= kMin && h % 3 == 0 && 4 * h == 3 * w)
    return {Mapping::HorizontalCross, "its shape is 4:3",
            isBlackOutside(image, Mapping::HorizontalCross)};
  if (h >= kMin && w % 3 == 0 && 2 * w == 3 * h)
    return {Mapping::CubeGrid, "its shape is 3:2", false};
  return {Mapping::LatLong, "no other mapping has its shape", false};
}

}  // namespace chromeball

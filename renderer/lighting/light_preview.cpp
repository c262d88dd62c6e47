// SPDX-License-Identifier: Apache-2.0
#include "lighting/light_preview.h"

#include "probe/preview.h"

namespace chromeball {
namespace {

constexpr int kWidth = 1024, kHeight = 512;

// A white dot with a black rim; it wraps at the seam.
void drawDot(Image& image, dvec2 uv) {
  constexpr double kRadius = 3, kRim = 5;
  const dvec2 centre = uv * dvec2(kWidth, kHeight);
  for (int y = int(centre.y - kRim); y <= int(centre.y + kRim); ++y)
    for (int x = int(centre.x - kRim - 1); x <= int(centre.x + kRim); ++x) {
      const double distance = glm::distance(centre, dvec2(x + 0.5, y + 0.5));
      if (y < 0 || y >= kHeight || distance > kRim) continue;
      image.setRgb((x + kWidth) % kWidth, y, Rgb(distance < kRadius ? 1 : 0));
    }
}

}  // namespace

Image lightPreview(const Image& latLong, const Constellation& lights) {
  Image preview = probePreview(Probe(latLong), kWidth);
  for (const DirectionalLight& light : lights)
    drawDot(preview, directionToUv(Mapping::LatLong, dvec3(light.direction)));
  return preview;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "lighting/light_preview.h"

#include "image/tonemap.h"
#include "probe/solid_angle.h"

namespace chromeball {
namespace {

constexpr int kWidth = 1024, kHeight = 512;

// The geometric mean of the luminance, which no sun can pull up, is shown as a middle grey.
DisplayTransform transformFor(const Image& latLong) {
  constexpr float kMiddleGrey = 0.18f;
  const float mean = luminance(Rgb(meanRadiance(latLong)));
  if (mean == 0) return {};
  double logarithms = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      logarithms += std::log2(std::fmax(luminance(latLong.rgb(x, y)), 1e-4f * mean));
  const double texels = double(latLong.width) * latLong.height;
  return {ToneOperator::Reinhard, std::log2(kMiddleGrey) - float(logarithms / texels)};
}

// White with a black rim, around the seam where need be.
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

Image probePicture(const Probe& probe, int width) {
  const DisplayTransform transform = transformFor(probe.latLong());
  Image picture(width, width / 2, 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto direction =
          uvToDirection(Mapping::LatLong, {(x + 0.5) / width, (y + 0.5) / picture.height});
      picture.setRgb(x, y, display(transform, probe.radiance(vec3(*direction))));
    }
  return picture;
}

Image lightPreview(const Image& latLong, const Constellation& lights) {
  Image preview = probePicture(Probe(latLong), kWidth);
  for (const DirectionalLight& light : lights)
    drawDot(preview, directionToUv(Mapping::LatLong, dvec3(light.direction)));
  return preview;
}

}  // namespace chromeball

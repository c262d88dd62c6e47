// SPDX-License-Identifier: Apache-2.0
#include "probe/preview.h"

#include "probe/solid_angle.h"

namespace chromeball {

DisplayTransform previewTransform(const Image& latLong) {
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

Image probePreview(const Probe& probe, int width) {
  const DisplayTransform transform = previewTransform(probe.latLong());
  const ImageSize size{width, width / 2};
  Image preview(size.width, size.height, 3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      preview.setRgb(x, y, display(transform, probe.radiance(vec3(texelDirection(size, x, y)))));
  return preview;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "viewers/relight_view.h"

#include <cmath>

#include "base/parallel.h"
#include "image/image.h"
#include "relight/stage/light_stage.h"
#include "relight/stage/relit_stage.h"

namespace chromeball {
namespace {

constexpr int kMapWidth = 512;

Image reduced(const Image& map) {
  if (map.width <= kMapWidth) return map;
  const int height = std::max(1, int(std::lround(double(map.height) * kMapWidth / map.width)));
  return resampled(map, kMapWidth, height);
}

}  // namespace

RelightView::RelightView(LightStage stage, std::vector<NamedProbe> probes)
    : stage_(std::move(stage)), probes_(std::move(probes)) {
  for (NamedProbe& probe : probes_) probe.map = reduced(probe.map);
}

std::vector<uint8_t> RelightView::picture(size_t probe, const Rotation& rotation,
                                          const DisplayTransform& transform) const {
  Image sum = weightedSum(stage_.elements,
                          lightWeights(stage_.basis, probes_[probe].map, rotation, kMapWidth));
  addOwnLight(sum, stage_.own);
  std::vector<uint8_t> bytes(4 * size_t(sum.width) * size_t(sum.height));
  forRows(sum.width, sum.height, 16, [&](int y) {
    uint8_t* to = bytes.data() + 4 * size_t(y) * size_t(sum.width);
    for (int x = 0; x < sum.width; ++x) {
      const Rgb shown = display(transform, sum.rgb(x, y));
      for (int c = 0; c < 3; ++c) *to++ = uint8_t(std::lround(255 * linearToSrgb(shown[c])));
      *to++ = 255;
    }
  });
  return bytes;
}

}  // namespace chromeball

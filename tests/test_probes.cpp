// SPDX-License-Identifier: Apache-2.0
#include "test_probes.h"

#include "probe/synth.h"

namespace chromeball {

Image spot(int width, int height, int x, int y, float radiance, float rest) {
  Image image = constantProbe({width, height}, Rgb(rest));
  image.setRgb(x, y, Rgb(radiance));
  return image;
}

std::vector<HardProbe> hardProbes() {
  std::vector<HardProbe> all;
  all.push_back({"constant", constantProbe({16, 8}, Rgb(0.3f))});
  all.push_back({"one texel", spot(32, 16, 11, 5, 1, 0)});
  all.push_back({"seam, last column", spot(32, 16, 31, 8, 1, 0)});
  all.push_back({"seam, first column", spot(32, 16, 0, 8, 1, 0)});
  all.push_back({"north pole", spot(32, 16, 3, 0, 1, 0)});
  all.push_back({"south pole", spot(32, 16, 20, 15, 1, 0)});
  all.push_back({"sun over a grey sky", spot(64, 32, 40, 9, 2000, 0.5f)});
  all.push_back({"3x2", gradientProbe({3, 2}, Rgb(1), {0.3, 0.5, 0.2})});
  all.push_back({"1x1", constantProbe({1, 1}, Rgb(2))});
  all.push_back({"2x1", spot(2, 1, 0, 0, 1, 0)});
  all.push_back({"gradient", gradientProbe({64, 32}, Rgb(1, 2, 3), {0.5, 0.5, 0.5})});
  return all;
}

}  // namespace chromeball

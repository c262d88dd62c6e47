// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/filter_transmission.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/error.h"
#include "math/cdf.h"

namespace chromeball {

FilterTransmission filterTransmission(const Image& with, const Image* clippedWith,
                                      const Image& without, const Image* clippedWithout) {
  const auto isMeasured = [](const Image& image, const Image* clipped, int x, int y) {
    const Rgb c = image.rgb(x, y);
    return c.x > 0 && c.y > 0 && c.z > 0 && isFinite(c) && !(clipped && *clipped->at(x, y) != 0);
  };
  dvec3 sumWith(0), sumWithout(0);
  std::array<std::vector<double>, 3> ratios;
  for (int y = 0; y < with.height; ++y)
    for (int x = 0; x < with.width; ++x) {
      if (!isMeasured(with, clippedWith, x, y) || !isMeasured(without, clippedWithout, x, y))
        continue;
      const dvec3 a(with.rgb(x, y)), b(without.rgb(x, y));
      sumWith += a, sumWithout += b;
      for (int c = 0; c < 3; ++c) ratios[size_t(c)].push_back(a[c] / b[c]);
    }
  FilterTransmission result{sumWith / sumWithout, dvec3(0), ratios[0].size()};
  if (result.pixels == 0) throwInput("no pixel is above 0 and not clipped in both images");
  for (int c = 0; c < 3; ++c) result.median[c] = median(std::move(ratios[size_t(c)]));
  return result;
}

}  // namespace chromeball

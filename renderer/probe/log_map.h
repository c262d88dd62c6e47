// SPDX-License-Identifier: Apache-2.0
// A probe's log radiance, in which two probes of one place are compared (align.h).
#pragma once

#include "image/image.h"

namespace chromeball {

// Makes log maps of any size of one lat-long map, which must outlive this. In each channel a log
// map is log(radiance / m + 1/20), m the channel's median over the sphere, blurred by a Gaussian
// whose sigma is the height of a texel, minus its mean over the sphere. So it does not depend on
// exposure and white balance, and is dominated neither by suns nor by dark noise. The blur is there
// for bilinear interpolation: it would make noise weaker between texels than at their centres.
class LogMaps {
 public:
  explicit LogMaps(const Image& latLong);

  // 2 x `height` by `height` texels.
  Image map(int height) const;

 private:
  const Image& latLong_;
  Rgb unit_;  // m; 1 where that is 0
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A picture of how a probe was assembled.
#pragma once

#include <vector>

#include "probe/capture/assemble.h"

namespace chromeball {

struct PhotographPreview {
  const Image* image;
  const Image* mask;  // empty for none
  Circle circle;
  double gain;  // brings the photograph to the radiance of the probe
};

// The photographs side by side, with their circles in red and the parts that the mask excludes
// darker; below them the probe (which may be filled), with stripes over its blind texels.
// Display-linear colours in [0, 1]; at most 1024 pixels wide.
Image assemblyPreview(const std::vector<PhotographPreview>& photographs, const Assembly& assembly);

}  // namespace chromeball

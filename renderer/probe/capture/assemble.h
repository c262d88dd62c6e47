// SPDX-License-Identifier: Apache-2.0
// One probe from photographs of a mirror ball, or through a fisheye lens (HDRI book,
// sections 9.2.1, 9.3.1 and 9.3.3).
#pragma once

#include <vector>

#include "probe/capture/match_views.h"
#include "probe/mapping.h"

namespace chromeball {

struct Assembly {
  Image latLong;          // blind texels are black
  Image coverage;         // one channel: the share of each texel that a view shows
  double blindShare = 0;  // of the sphere: directions that no view shows
};

// Each texel is the mean, over the part of its solid angle that the views show, of merged(): a
// weighted mean of the views. Parallel, the same for any number of threads.
Assembly assemble(const std::vector<CaptureView>& views, const ImageSize& size);

// The lat-long map whose texels at the horizon are as large as the mean pixel of the finest view,
// of at most 8192 rows.
ImageSize assemblySize(const std::vector<CaptureView>& views);

// The fill of texels without coverage.
struct BlindFill {
  bool isSmooth = false;     // the others, continued
  Rgb color{0};              // else this
  std::optional<Image> map;  // or the radiance of this lat-long map
};
// Throws InputError for a smooth fill if no texel has coverage.
void fillBlind(const BlindFill& fill, Assembly& assembly);

// The smooth fill: the harmonic function that continues the other texels, which has no extrema of
// its own. It is computed from a coarse map to the full one, with a fixed number of relaxations of
// each.
void inpaintBlind(Assembly& assembly);

// A picture of how a probe was assembled.

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

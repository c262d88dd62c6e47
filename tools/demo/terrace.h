// SPDX-License-Identifier: Apache-2.0
// The demo of compositing: a terrace with a wall, two pillars and a vase, and synthetic objects.
#pragma once

#include <string>

#include "image/image.h"

namespace chromeball::demo {

enum class Terrace {
  Photograph,  // the terrace with its true materials, rendered as the plate
  Whole,       // the same with the objects, rendered as the reference image of the composite
  Model,       // the objects and a grey model of the terrace, rendered for the composite
};

// Writes a .glb with a camera named View. The grey model has the same node names as the true
// terrace: floor, wall, pillar (two of them), vase. Throws RunError.
void writeTerrace(const std::string& path, Terrace what);

// The probe that belongs to it: a clear sky, the sun to the left and behind us. Lat-long, `width` x
// `width` / 2.
Image terraceProbe(int width);

}  // namespace chromeball::demo

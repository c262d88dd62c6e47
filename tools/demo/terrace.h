// SPDX-License-Identifier: Apache-2.0
// The composite's demo: a terrace with a wall, two pillars and a vase, and what is put there.
#pragma once

#include <string>

#include "image/image.h"

namespace chromeball::demo {

enum class Terrace {
  Photograph,  // the real things alone, as they are: the plate is a picture of them
  Whole,       // the same with the objects: what a composite should come to
  Model,       // the objects among grey stand-ins for the real things: what is rendered
};

// A .glb with a camera named View. Stand-ins and real things have the same names: floor, wall,
// pillar (two of them), vase. Throws RunError.
void writeTerrace(const std::string& path, Terrace what);

// The probe that belongs to it: a clear sky, the sun to the left and behind us. Lat-long, `width` x
// `width` / 2.
Image terraceProbe(int width);

}  // namespace chromeball::demo

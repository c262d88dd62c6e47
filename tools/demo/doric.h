// SPDX-License-Identifier: Apache-2.0
// The parts of a temple of the Doric order, in metres: columns and triglyphs.
#pragma once

#include "shapes.h"

namespace chromeball::demo {

// A column from the stylobate to the architrave: a fluted shaft, an echinus and a square abacus.
struct DoricColumn {
  double height = 10.4, shaft = 9.54;             // of the whole, and of its shaft
  double lowerRadius = 0.95, upperRadius = 0.74;  // to the arrises between the flutes
  double entasis = 0.02;                          // swelling in the middle of the shaft
  double abacus = 1.0;                            // half its width
  int flutes = 20;
};

// Radius to the arrises at a height of the shaft: linear taper, and a parabola for the entasis.
double radiusAt(const DoricColumn& column, double height);

// The column stands on the origin. Flutes are arcs of circles of a depth of 7% of the radius.
Surface shaft(const DoricColumn& column);
Surface capital(const DoricColumn& column);

// A block with two grooves and a chamfer at each end, `width` along x, its back on z = 0, standing
// on y = 0.
Surface triglyph(float width, float height);

}  // namespace chromeball::demo

// SPDX-License-Identifier: Apache-2.0
// A small basilica: a nave with a barrel vault between arcades, aisles, a clerestory and an apse.
#pragma once

#include <string>

#include "math/vec.h"

namespace chromeball::demo {

enum class Nave {
  Whole,   // the room with monoliths and spheres in it
  Room,    // the room alone: what a probe captures, and onto which it is mapped again
  Things,  // the monoliths and spheres on the room's floor, for the light of that probe
};

// Writes a .glb with a camera named View. Throws RunError.
void writeNave(const std::string& path, Nave what);

// The room's measures, in metres: it lies along z, the apse is at negative z, the floor at y = 0.
struct NaveMeasures {
  float halfWidth = 5, aisle = 10;  // from the middle to the arcade and to the outer wall
  float wall = 0.8f;                // thickness
  float bay = 5;
  int bays = 7;
  float springOfVault = 13;
  float clerestory = 8.2f, windowSill = 1.1f, windowSpring = 3.2f, windowHalfWidth = 0.95f;
  float apse = 4, apseSpring = 8.6f;  // radius; the height from which its conch rises
  float halfLength() const { return bay * float(bays) / 2; }
  // The middle of the opening of a window of the clerestory; side -1 or 1, in the middle of the
  // wall's thickness.
  vec3 window(int bayIndex, float side) const {
    return {side * (halfWidth + wall / 2), clerestory + (windowSill + windowSpring) / 2,
            -halfLength() + bay * (float(bayIndex) + 0.5f)};
  }
};

}  // namespace chromeball::demo

// SPDX-License-Identifier: Apache-2.0
// The demo's model: six objects on a round table.
#pragma once

#include <string>

namespace chromeball::demo {

enum class Finish {
  Demo,        // metals, plastic, wood, a lantern that glows
  Lambertian,  // all diffuse, so that the images of any two renderers should agree
  Conductors,  // diffuse, except for three metals of roughness 0.2 and more
  Glass,       // diffuse, except for a ball and a knot of smooth glass
  Plastics,    // diffuse below a glossy dielectric layer
  Room,        // Lambertian, in a room with one window
  Lamp,        // Lambertian, in a closed room; the only light is a filament in a bulb of glass
  Caustics,    // a mirror and a golden ball on a diffuse ground, nothing else
  Fine,        // Lambertian, of 0.9 million triangles
};

// Writes a .glb of some 66,000 triangles, except Fine and Caustics, with a camera named Front.
// Throws RunError.
void writeStillLife(const std::string& path, Finish finish);

}  // namespace chromeball::demo

// SPDX-License-Identifier: Apache-2.0
// The models of the demo and of the gallery's scenes, each a .glb with a camera, and their probes.
// Those that write throw RunError.
#pragma once

#include <string>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball::demo {

// The still life of the demo: six objects on a round table.
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
void writeStillLife(const std::string& path, Finish finish);

// A terrace with a wall, two pillars and a vase, and synthetic objects: the demo of compositing.
enum class Terrace {
  Photograph,  // the terrace with its true materials, rendered as the plate
  Whole,       // the same with the objects, rendered as the reference image of the composite
  Model,       // the objects and a grey model of the terrace, rendered for the composite
};

// Writes a .glb with a camera named View. The grey model has the same node names as the true
// terrace: floor, wall, pillar (two of them), vase.
void writeTerrace(const std::string& path, Terrace what);

// The probe that belongs to it: a clear sky, the sun to the left and behind us. Lat-long, `width` x
// `width` / 2.
Image terraceProbe(int width);

// Ball, cone, cube, ring and cylinder of different materials on a slab of stone (HDRI figure 9.1).
void writeFiveShapes(const std::string& path);

// Balls of glass, metal and plastic on stands about a pedestal of marble (HDRI figure 9.3).
void writePedestal(const std::string& path);

// A Doric temple on a hill; its columns are instances (HDRI figures 9.22 to 9.28).
void writeTemple(const std::string& path);

// A small basilica: a nave with a barrel vault between arcades, aisles, a clerestory and an apse.
enum class Nave {
  Whole,   // the room with monoliths and spheres in it
  Room,    // the room alone: what a probe captures, and onto which it is mapped again
  Things,  // the monoliths and spheres on the room's floor, for the light of that probe
};

// Writes a .glb with a camera named View.
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

// A light probe: a lake among hills at dusk, computed procedurally. A lat-long map, `width` x
// `width` / 2. Relative radiance; the low sun is a soft disc.
Image paintDusk(int width);

}  // namespace chromeball::demo

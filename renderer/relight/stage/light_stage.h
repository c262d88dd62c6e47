// SPDX-License-Identifier: Apache-2.0
// A light stage: pictures of one scene under each of many lighting conditions (HDRI book, section
// 9.9; Debevec et al. 2000).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "image/image.h"
#include "probe/probe.h"
#include "relight/stage/direction_basis.h"

namespace chromeball {

// The whole, or a band of its rows.
struct LightStage {
  DirectionBasis basis;
  // Pixel by pixel, three channels for each element of the basis: radiance where the element's
  // function is the radiance that arrives from each direction. The elements of cells add to the
  // picture under unit radiance from everywhere.
  Image elements;
  Image own;  // radiance that the scene has from its own lights; empty: it has none

  int width() const { return elements.width; }
  int height() const { return elements.height; }
};

// The most that a file may hold: 256 GiB of float32.
inline constexpr uint64_t kMaxStageNumbers = uint64_t(1) << 36;

// The most numbers that a file may have for each pixel.
int stageChannels(const DirectionBasis& basis);

// Throws InputError, begun by `location`, if a stage of this size exceeds kMaxStageNumbers.
void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location);

// The bytes of a pixel's elements in memory.
double elementBytes(const DirectionBasis& basis);

// Throws InputError, begun by `location`, if the elements take more than `memory` bytes.
void checkInMemory(const DirectionBasis& basis, int width, int height, double memory,
                   std::string_view location);

// The probe's weight for each function of the basis. For cells: the mean radiance of the rotated
// probe over each. For spherical harmonics: the integral of radiance times the function. Computed
// by quadrature over the bilinear interpolation of the map, each point with its exact solid angle,
// on a grid of at least the map's texels: 4096 x 2048 points or more for cells, so that a cell's
// edge is off by 0.04 degrees at most. Parallel; the same bits for any number of threads.
std::vector<Rgb> lightWeights(const DirectionBasis& basis, const Image& latLong,
                              const Rotation& rotation, int leastWidth = 4096);

// How much light from each direction a pixel reflects, as a picture over the directions (HDRI book,
// section 9.9.2, Figure 9.45).

// A lat-long map of radiance per irradiance on a surface that faces the light, 1/sr: f cos x
// visibility, and interreflection. For boxes it has one texel each; for other bases 64 x 32 texels,
// each showing the cell at its centre, or the sum of the harmonics.
Image reflectanceFunction(const LightStage& stage, int x, int y);

// A light stage from photographs: pictures of a subject under a lamp in each of many directions
// (HDRI book, section 9.9.1, Figure 9.42).

struct StagePhotograph {
  std::string file;  // relative to the photographs' folder
  vec3 direction;    // unit, towards the lamp
};

// Lines `FILE,X,Y,Z` (a direction of any length) or `FILE,AZIMUTH,ELEVATION` (degrees:
// directionAt(), probe/mapping.h), all of one kind. A first line with names, empty lines and lines
// that begin with # are skipped. Throws InputError ("CSV:LINE: reason") for other lines, and for a
// file or a direction that occurs twice.
std::vector<StagePhotograph> readPhotographs(const std::filesystem::path& csv);

// Each image shows the subject under distant light whose irradiance on a surface that faces it is
// `irradiance`. It stands for the light of its Voronoi cell on the sphere: the element is the image
// x the cell's solid angle / irradiance. Images are linear; files with integers are decoded as
// sRGB. `messages` gets the readers'. Throws InputError for images of different size or with values
// that are not finite, and if the stage takes more than `memory` bytes.
LightStage stageOf(const std::filesystem::path& folder,
                   const std::vector<StagePhotograph>& photographs, float irradiance, double memory,
                   Messages& messages);

}  // namespace chromeball

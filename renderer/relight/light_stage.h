// SPDX-License-Identifier: Apache-2.0
// A light stage: pictures of one scene under each of many lighting conditions (HDRI book, section
// 9.9; Debevec et al. 2000), and its file.
#pragma once

#include <filesystem>

#include "image/image.h"
#include "image/io/read_image.h"
#include "relight/direction_basis.h"

namespace chromeball {

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

// Throws InputError, begun by `location`, if a stage of this size exceeds what a file may hold.
void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location);

// An .exr: R, G, B are `color`, then the layers element.0000, element.0001, ... and own. `halves`:
// in 16 bits. Throws RunError.
void writeStage(const std::filesystem::path& path, const LightStage& stage, const Image& color,
                Metadata metadata, bool halves);

// Throws InputError for a file that is not one that writeStage() wrote, that lacks elements, or has
// values that are not finite.
LightStage readStage(const std::filesystem::path& path);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// A light stage: pictures of one scene under each of many lighting conditions (HDRI book, section
// 9.9; Debevec et al. 2000).
#pragma once

#include <cstdint>
#include <string_view>

#include "image/image.h"
#include "relight/direction_basis.h"

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

// What a file may hold: 256 GiB of float32.
inline constexpr uint64_t kMaxStageNumbers = uint64_t(1) << 36;

// A file's numbers for each pixel, at most.
int stageChannels(const DirectionBasis& basis);

// Throws InputError, begun by `location`, if a stage of this size exceeds kMaxStageNumbers.
void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location);

// The bytes of a pixel's elements in memory.
double elementBytes(const DirectionBasis& basis);

// Throws InputError, begun by `location`, if the elements take more than `memory` bytes.
void checkInMemory(const DirectionBasis& basis, int width, int height, double memory,
                   std::string_view location);

}  // namespace chromeball

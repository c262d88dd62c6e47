// SPDX-License-Identifier: Apache-2.0
// Which channels of an image file are its colour: radiance, or a photograph's.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

// The channels of one part of a file. If there are several parts, each has a name, which describes
// its contents as a layer's name does.
struct PartChannels {
  std::string name;  // empty: the only part, or without a name
  std::vector<std::string> channels;
};

struct ColorChannels {
  size_t part = 0;
  std::string layer;                  // empty: none; a part's name if the channels have no layer
  std::vector<std::string> channels;  // R, G and B, or one channel of grey
  std::vector<std::string> others;    // layers with colour that were not taken
};

// The colour channels, searched in this order: R, G and B without a layer; in the layers Combined,
// beauty, rgba and C; in a layer with the word beauty; in another layer, unless a word of its name
// says that it is no light (AO, albedo, normal, depth, mask, crypto, ...); Y; the only channel, if
// its name does not say that it is something else (A, Z, R, ...) or no light. nullopt if there is
// none of these.
std::optional<ColorChannels> findColorChannels(std::span<const PartChannels> parts);

// Whether R, G and B of a layer of this name are a colour, of light or of a surface (albedo), that
// has primaries: not a normal, a position, a mask, a statistic.
bool isColorLayer(const std::string& layer);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Puts the shards and crops of a render together.
#pragma once

#include <string>
#include <vector>

#include "image/io/read_image.h"
#include "parts/checkpoint.h"

namespace chromeball {

// The parts in an order that is independent of the order of the arguments, so that the sums have
// the same bits. Only their headers have been read.
class PartSet {
 public:
  // Throws InputError, naming the file or the part, if one belongs to another render, is there
  // twice, or is missing.
  explicit PartSet(const std::vector<std::string>& paths);

  const std::vector<std::string>& paths() const { return paths_; }

 private:
  std::vector<std::string> paths_;
};

// The whole render, or its samples so far.
struct MergedParts {
  RenderPart part;
  RenderResult result;
  uint32_t samplesOfCrop = 0;  // per pixel, of the shards of one crop
  double samplesOfPixels = 0;  // sum over the pixels of all complete crops

  // Adds a part with so many samples per pixel; the shards of a crop in order.
  void addSamples(const RenderSettings& ofPart, uint32_t samples);
};

// Reads one part after the other, each by all threads. Takes the memory of the whole result and of
// some rows for each thread. `progress` receives fractions. Throws InputError.
MergedParts merge(const PartSet& parts, const Progress& progress);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// One image of high dynamic range from photographs that differ in exposure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/message.h"
#include "image/image.h"
#include "image/io/read_image.h"
#include "probe/capture/exposure.h"

namespace chromeball {

struct MergedExposures {
  Image radiance;  // three channels
  Image clipped;  // one channel: 1 where the radiance is only a lower bound in some channel, else 0
  size_t clippedPixels = 0, underexposedPixels = 0;  // in some channel

  struct Use {
    size_t saturated = 0;  // pixels, in some channel
    size_t weighted = 0;   // pixels that the image takes something from
  };
  std::vector<Use> uses;  // of each exposure
};

// Debevec and Malik (1997), eq. 6: ln L is the mean of g(level) - ln k over the exposures, weighted
// by a hat. A channel that is saturated in all exposures where it is not black gives a lower bound,
// from the shortest saturated exposure. A channel that is black in all exposures, or NaN, is
// under-exposed: 0.
//
// All images have the same size; there is at least one. Parallel; the same bits for any number of
// threads.
MergedExposures mergeExposures(std::span<const Exposure> exposures, const ResponseCurve& response);

// Reads the photographs of a series.

struct PhotographLevels {
  std::vector<Image> levels;  // as encoded, divided by `white`; three channels; of one size
  std::optional<Chromaticities> primaries;  // of the channels; nullopt: Rec. 709's, or grey
  std::optional<Transfer> transfer;         // that the files state
  int bits = 0;                             // of the files' channels; 0: floats
  float white = 1;                          // the texel of the files that is level 1
  std::vector<size_t> invalid;  // channels of each file that are NaN or negative: level 0
  Metadata metadata;            // of the first file
  Messages messages;            // of the readers

  // As the files state, or else by their bits.
  bool isSrgb() const { return transfer ? *transfer == Transfer::Srgb : bits == 8; }
};

// `resizes`: photographs of several sizes are crops of one thing, such as a ball, and are resampled
// to the smallest width and height: means of linear light, with 8 bits taken for sRGB-encoded
// unless they state otherwise; a pixel that covers a saturated one is saturated. `white` is the
// white level of float files; the default is 1, or their largest texel if that is higher. Integers
// are white at 1. Throws InputError if a file is no image, if sizes, kinds of numbers, primaries or
// stated transfers differ, and for a `white` of integers.
PhotographLevels readLevels(const std::vector<std::string>& files, std::optional<float> white,
                            bool resizes = false);

// The camera's settings of photographs, from their EXIF blocks or from the user.

// `times` (seconds) and `apertures` (f-numbers), one for each file, replace those of EXIF; either
// may be empty. If there are times, nothing is read from the files, not even the ISO. Otherwise
// each file must state its time, and all of them or none the aperture and the ISO. Throws
// InputError.
std::vector<CameraSettings> cameraSettings(const std::vector<std::string>& files,
                                           const std::vector<double>& times,
                                           const std::vector<double>& apertures);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Merges the files of a series of photographs into an image of high dynamic range.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"
#include "image/image.h"
#include "probe/capture/exposure.h"
#include "probe/capture/merge_exposures.h"
#include "probe/mapping.h"

namespace chromeball {

struct PhotographSeries {
  std::vector<std::string> files;
  std::vector<double> times, apertures;  // as in cameraSettings() (merge_exposures.h)
  std::vector<ApertureRatio> apertureRatios;

  struct Filter {
    size_t photograph;   // index
    dvec3 transmission;  // above 0
  };
  std::vector<Filter> filters;

  struct FlatField {
    std::optional<double> aperture;  // of the photographs to divide; nullopt: all
    std::string file;
  };
  std::vector<FlatField> flatFields;

  // linear, srgb, solve (exposure.h) or a file (ResponseCurve::read()). Empty: the response that
  // the files state, else srgb for 8 bits, else linear.
  std::string response;
  double smoothness = 20;      // of solve
  std::optional<float> white;  // of float files (merge_exposures.h)
  bool checkAlignment = true;  // align.h
  bool resizes = false;        // merge_exposures.h
};

struct MergedPhotographs {
  MergedExposures image;
  std::vector<CameraSettings> settings;  // of each photograph
  std::vector<dvec3> factors;
  std::vector<ExposureAgreement> agreements;
  ResponseCurve response = ResponseCurve::linear();
  std::string responseName;
  float white = 1;
  glm::dmat3 toRec709{1};  // from the photographs' channels
  Metadata metadata;       // of the first photograph
  Messages messages;
};

// Throws InputError if files, settings or options do not fit together, if the exposures are all the
// same, if photographs are shifted against each other, and if all pixels are saturated, or black,
// in all of them.
MergedPhotographs mergePhotographs(const PhotographSeries& series);

// The transmission of a filter in front of a camera.

struct FilterTransmission {
  dvec3 transmission;  // sum with / sum without, over the pixels
  dvec3 median;        // of the pixels' ratios: differs if something moved, or light leaks in
  size_t pixels = 0;
};

// The filter's transmission, from linear images of one view with and without it (HDRI book, section
// 9.3.5); both have the same size and three channels. Masks (one channel; may be null) are not 0
// where radiance is only a bound; these pixels, and pixels with a channel that is not above 0, are
// left out. Throws InputError if none is left.
FilterTransmission filterTransmission(const Image& with, const Image* clippedWith,
                                      const Image& without, const Image* clippedWithout);

}  // namespace chromeball

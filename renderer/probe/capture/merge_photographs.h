// SPDX-License-Identifier: Apache-2.0
// From the files of a series of photographs to an image of high dynamic range.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"
#include "probe/capture/exposure.h"
#include "probe/capture/merge_exposures.h"

namespace chromeball {

struct PhotographSeries {
  std::vector<std::string> files;
  std::vector<double> times, apertures;  // as in cameraSettings() (camera_settings.h)
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

  // linear, srgb, solve (solve_response.h) or a file (response_curve.h). Empty: what the files
  // state, else srgb for 8 bits, else linear.
  std::string response;
  double smoothness = 20;      // of solve
  std::optional<float> white;  // of float files (read_levels.h)
  bool checkAlignment = true;  // find_shift.h
  bool resizes = false;        // read_levels.h
};

struct MergedPhotographs {
  MergedExposures image;
  std::vector<CameraSettings> settings;  // of each photograph
  std::vector<dvec3> factors;
  std::vector<ExposureAgreement> agreements;
  ResponseCurve response = ResponseCurve::linear();
  std::string responseName;
  float white = 1;
  Messages messages;
};

// Throws InputError if files, settings or options do not fit together, if the exposures are all the
// same, if photographs are shifted against each other, and if all pixels are saturated, or black,
// in all of them.
MergedPhotographs mergePhotographs(const PhotographSeries& series);

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Photographs of one view that differ in exposure, the exposures by the camera's settings, and its
// response.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

// How a camera encodes exposure, inverted.

// Maps levels, 0 to 1 = white, to exposure: radiance x exposure time x transmission, in a unit in
// which sRGB's white is 1.
class ResponseCurve {
 public:
  static ResponseCurve linear() { return ResponseCurve(Kind::Linear, {}); }
  static ResponseCurve srgb() { return ResponseCurve(Kind::Srgb, {}); }

  // The logarithms of the exposures of the levels 0, 1/255, ... 1, in increasing order, for each
  // channel. Between them the logarithm is interpolated.
  static constexpr int kLevels = 256;
  explicit ResponseCurve(std::vector<dvec3> logExposures)
      : ResponseCurve(Kind::Table, std::move(logExposures)) {}

  // The exposure's logarithm; -infinity where the exposure is 0. `level` is at least 0; above 1 a
  // curve that is a table stays at its end.
  double logExposure(int channel, double level) const;

  // A text file: the header `level,red,green,blue`, then for each of the 256 levels its number, 0
  // to 255, and the exposures (not their logarithms). Lines that begin with # are comments. Reading
  // throws InputError for any other file, or an exposure is not above the one before it; writing is
  // atomic and throws RunError.
  static ResponseCurve read(const std::filesystem::path& path);
  void write(const std::filesystem::path& path) const;

 private:
  enum class Kind { Linear, Srgb, Table };
  ResponseCurve(Kind kind, std::vector<dvec3> table) : kind_(kind), table_(std::move(table)) {}

  Kind kind_;
  std::vector<dvec3> table_;
};

// Photographs that differ in exposure.

struct CameraSettings {
  double time = 1;                 // seconds
  std::optional<double> aperture;  // f-number
  std::optional<double> iso;
};

// Exposures at aperture `from` receive `ratio` times the light of exposures at aperture `to`, as
// measured. By the f-numbers alone it would be (to / from)^2, which lenses miss by several percent
// (HDRI book, section 9.3.5: 16.63 for f/4 to f/16).
struct ApertureRatio {
  double from, to, ratio;
};

inline bool isSameAperture(double a, double b) { return std::abs(a - b) <= 0.01 * a; }

// Radiance x factor = exposure: time x ISO / 100 / N^2, without what is unknown. A ratio changes
// the factors of its aperture `to`; it may start from one that an earlier ratio changed. Throws
// InputError if a ratio names an aperture that no photograph has, or changes one that another ratio
// has used.
std::vector<double> exposureFactors(std::span<const CameraSettings> photographs,
                                    std::span<const ApertureRatio> ratios);

// A photograph and its factor, with the transmission of a filter in it.
struct Exposure {
  std::string name;                  // for messages
  Image levels;                      // as encoded; three channels; 1 is white
  dvec3 factor;                      // for each channel, above 0
  const Image* flatField = nullptr;  // its exposure is divided by this; three channels, above 0
};

// Levels from kSaturated on are only a lower bound on the exposure, kSaturated's: JPEG blurs
// clipped regions by some levels.
inline constexpr float kSaturated = 250 / 255.f;

// The hat of Debevec and Malik, 1 in the middle; 0 for levels without information: saturated, black
// or NaN.
inline float hatWeight(float level) {
  return level > 0 && level < kSaturated ? 2 * std::min(level, 1 - level) : 0;
}

// The step between rows and between columns that leaves at most about a million pixels: enough for
// statistics of an image.
int sampleStep(const Image& image);

// Whether photographs of one view differ as their exposures say.

struct ExposureAgreement {
  size_t longer, shorter;  // two exposures, by index
  double factor;           // of their green channels' exposures, as given
  // The ratio of the exposure found to the given one: the median over pixels for each channel; NaN
  // for a channel without enough pixels that both exposures show well.
  dvec3 found;
  size_t pixels = 0;  // in the channel that has the fewest

  // The largest difference of `found` from 1; nullopt if no channel has enough pixels.
  std::optional<double> error() const;
};

// The agreement of each exposure but the longest with the next longer one. Pixels are compared
// where, by the longer one, it has at most 85% and the shorter one at least 1% of the exposure of
// white: a choice by the shorter one would prefer pixels that noise brightens.
std::vector<ExposureAgreement> exposureAgreement(std::span<const Exposure> exposures,
                                                 const ResponseCurve& response);

// A camera's response from photographs of one view that differ in exposure.

// Debevec and Malik (1997), eq. 3: the curve g, one for each channel, that minimises the squared
// differences of a pixel's exposures, weighted by a hat, plus `smoothness` times g'' squared. Where
// the paper chooses pixels, about a million are used here, so their data count as if there was one
// pixel for each of the 256 levels. g is fixed at level 128, to sRGB's value in all channels: the
// scale of each channel cannot be determined.
//
// Where all exposures differ by powers of one ratio, as brackets do, ln L is only known up to any
// function that repeats itself with that ratio: only smoothness decides. With 20, the responses of
// cameras (sRGB, powers, S-shaped) are found within a level from 8-bit photographs with a noise of
// 1.5 levels; the response of linear 8-bit files is found only from irregular exposures.
//
// The levels are multiples of 1/255. Throws InputError if no level is well exposed in two images of
// different exposure, and if the curve that fits best is not increasing.
ResponseCurve solveResponse(std::span<const Exposure> exposures, double smoothness);

}  // namespace chromeball

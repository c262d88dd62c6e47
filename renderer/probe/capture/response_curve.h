// SPDX-License-Identifier: Apache-2.0
// How a camera encodes exposure, inverted.
#pragma once

#include <filesystem>
#include <vector>

#include "probe/mapping.h"

namespace chromeball {

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

}  // namespace chromeball

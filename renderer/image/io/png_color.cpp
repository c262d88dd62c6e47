// SPDX-License-Identifier: Apache-2.0
#include "image/io/png_color.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "image/io/metadata_blocks.h"

namespace chromeball {
namespace {

// Numbers of chunks are multiples of 1/100000.
template <size_t kCount>
std::optional<std::array<double, kCount>> numbersIn(std::span<const uint8_t> chunk) {
  if (chunk.size() != 4 * kCount) return {};
  std::array<double, kCount> numbers;
  for (size_t i = 0; i < kCount; ++i) {
    const uint8_t* b = &chunk[4 * i];
    numbers[i] = double(uint32_t(b[0]) << 24 | b[1] << 16 | b[2] << 8 | b[3]) / 100000;
  }
  return numbers;
}

float powerToLinear(float sample, double exponent) {
  return float(std::pow(double(sample), exponent));
}

// The inverse of the cameras' curve, with its constants of ITU-T H.273.
float rec709ToLinear(float sample) {
  constexpr double kAlpha = 1.099296826809442, kBeta = 0.018053968510807;
  if (sample < 4.5 * kBeta) return float(sample / 4.5);
  return powerToLinear(float((sample + (kAlpha - 1)) / kAlpha), 1 / 0.45);
}

// Code points of ITU-T H.273, tables 2 and 3.
std::optional<Chromaticities> primariesOf(uint8_t code) {
  constexpr glm::dvec2 kD65(0.3127, 0.329), kDci(0.314, 0.351);
  switch (code) {
    case 1:  // Rec. 709
    case 2:  // unspecified
      return {};
    case 5:  // Rec. 601 of 625 lines
      return Chromaticities{{0.64, 0.33}, {0.29, 0.6}, {0.15, 0.06}, kD65};
    case 6:  // of 525 lines
    case 7:
      return Chromaticities{{0.63, 0.34}, {0.31, 0.595}, {0.155, 0.07}, kD65};
    case 9:
      return Chromaticities{{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, kD65};  // Rec. 2020
    case 11:                                                                       // DCI-P3
      return Chromaticities{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kDci};
    case 12:  // Display P3
      return Chromaticities{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65};
    default:
      throw std::runtime_error(
          fmt::format("its cICP chunk states primaries that are not known here, {}", code));
  }
}

DecodeSample transferOf(uint8_t code) {
  switch (code) {
    case 1:  // Rec. 709, 601 and 2020
    case 6:
    case 14:
    case 15:
      return rec709ToLinear;
    case 2:  // unspecified
    case 13:
      return srgbToLinear;
    case 4:
      return [](float sample) { return powerToLinear(sample, 2.2); };
    case 5:
      return [](float sample) { return powerToLinear(sample, 2.8); };
    case 8:
      return [](float sample) { return sample; };
    default:
      throw std::runtime_error(fmt::format(
          "its cICP chunk states {}, which is not decoded here: convert it to linear .exr or .hdr",
          code == 16   ? "the transfer PQ (SMPTE ST 2084)"
          : code == 18 ? "the transfer HLG (ARIB STD-B67)"
                       : fmt::format("a transfer that is not known, {}", code)));
  }
}

std::optional<Transfer> statedTransfer(uint8_t code) {
  switch (code) {
    case 2:  // unspecified
      return {};
    case 8:
      return Transfer::Linear;
    case 13:
      return Transfer::Srgb;
    default:
      return Transfer::Other;
  }
}

PngColor colorOfCodePoints(std::span<const uint8_t> chunk) {
  const uint8_t primaries = chunk[0], transfer = chunk[1], matrix = chunk[2], fullRange = chunk[3];
  if (matrix != 0 || fullRange != 1)
    throw std::runtime_error(
        "its cICP chunk states samples that are not RGB of the full range, which are not decoded "
        "here");
  return {transferOf(transfer), primariesOf(primaries), statedTransfer(transfer)};
}

}  // namespace

PngColor pngColor(std::span<const uint8_t> file) {
  constexpr size_t kCodePoints = 4;
  if (const auto chunk = pngChunk(file, "cICP"); chunk.size() == kCodePoints)
    return colorOfCodePoints(chunk);
  if (!pngChunk(file, "sRGB").empty()) return {.transfer = Transfer::Srgb};
  PngColor color;
  if (const auto gamma = numbersIn<1>(pngChunk(file, "gAMA")); gamma && (*gamma)[0] > 0) {
    // What writers of sRGB state is 1/2.2, a power near its curve.
    constexpr double kOfSrgb = 1 / 2.2, kTolerance = 0.05;
    const double exponent = 1 / (*gamma)[0];
    const bool isSrgb = std::abs((*gamma)[0] / kOfSrgb - 1) <= kTolerance;
    color.transfer = isSrgb ? Transfer::Srgb : exponent == 1 ? Transfer::Linear : Transfer::Other;
    if (!isSrgb)
      color.decode = [exponent](float sample) { return powerToLinear(sample, exponent); };
  }
  if (const auto n = numbersIn<8>(pngChunk(file, "cHRM")))
    color.primaries = Chromaticities{
        {(*n)[2], (*n)[3]}, {(*n)[4], (*n)[5]}, {(*n)[6], (*n)[7]}, {(*n)[0], (*n)[1]}};
  return color;
}

}  // namespace chromeball

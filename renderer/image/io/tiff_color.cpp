// SPDX-License-Identifier: Apache-2.0
#include "image/io/tiff_color.h"

#include <stdexcept>

#include "image/io/tiff_block.h"

namespace chromeball {
namespace {

constexpr uint16_t kTransferFunction = 301, kWhitePoint = 318, kPrimaryChromaticities = 319;

std::vector<double> chromaticitiesIn(const TiffBlock& tiff, uint16_t tag, size_t count) {
  std::vector<double> numbers = tiff.rationals(tiff.firstDirectory(), tag);
  if (numbers.size() != count)
    throw std::runtime_error(
        "its WhitePoint or PrimaryChromaticities are not two and six rational numbers");
  return numbers;
}

}  // namespace

std::optional<Chromaticities> tiffPrimaries(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  const auto states = [&](uint16_t tag) { return tiff.has(tiff.firstDirectory(), tag); };
  if (!states(kWhitePoint) && !states(kPrimaryChromaticities)) return {};
  Chromaticities space;
  if (states(kWhitePoint)) {
    const std::vector<double> xy = chromaticitiesIn(tiff, kWhitePoint, 2);
    space.white = {xy[0], xy[1]};
  }
  if (states(kPrimaryChromaticities)) {
    const std::vector<double> xy = chromaticitiesIn(tiff, kPrimaryChromaticities, 6);
    space.red = {xy[0], xy[1]}, space.green = {xy[2], xy[3]}, space.blue = {xy[4], xy[5]};
  }
  return space;
}

bool statesGrey(std::span<const uint8_t> file) {
  constexpr uint16_t kPhotometricInterpretation = 262;
  const TiffBlock tiff(file);
  const std::vector<uint64_t> stated =
      tiff.integers(tiff.firstDirectory(), kPhotometricInterpretation);
  constexpr uint64_t kLargestOfGrey = 1;  // 0 if 0 is white
  return !stated.empty() && stated[0] <= kLargestOfGrey;
}

bool hasTransferTable(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  return tiff.has(tiff.firstDirectory(), kTransferFunction);
}

}  // namespace chromeball

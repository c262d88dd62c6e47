// SPDX-License-Identifier: Apache-2.0
#include "relight/relight.h"

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>

#include "base/error.h"
#include "base/for_ranges.h"
#include "base/suggest.h"
#include "relight/dct.h"
#include "relight/haar.h"

namespace chromeball {
namespace {

// The magnitudes of floats have the order of their bits. Bins are 2^-11 wide, relatively.
constexpr int kBinShift = 12;
constexpr size_t kBins = size_t(1) << (31 - kBinShift);

size_t binOf(float value) { return (std::bit_cast<uint32_t>(value) & 0x7fffffffu) >> kBinShift; }

// Products of values and weights, whose channels alternate: eight partial sums for each channel.
Rgb product(const float* values, const float* weights, size_t count) {
  constexpr size_t kLanes = 24;
  std::array<float, kLanes> sums{};
  size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (size_t k = 0; k < kLanes; ++k) sums[k] += values[i + k] * weights[i + k];
  for (; i < count; ++i) sums[i % 3] += values[i] * weights[i];
  Rgb total(0);
  for (size_t k = 0; k < kLanes; k += 3) total += Rgb(sums[k], sums[k + 1], sums[k + 2]);
  return total;
}

}  // namespace

RelightDomain parseDomain(const std::string& name, const DirectionBasis& basis) {
  using enum RelightDomain;
  const bool isSh = !basis.hasCells();
  const auto needs = [&](bool holds, const char* what) {
    if (!holds) throwInput("--domain {}: needs {}; this stage has {}", name, what, basis.name());
  };
  if (name == "auto") return isSh ? Sh : Pixel;
  if (name == "pixel") {
    needs(!isSh, "cells of directions, such as lat-long:32x16");
    return Pixel;
  }
  if (name == "sh") {
    needs(isSh, "spherical harmonics, such as sh:2");
    return Sh;
  }
  if (name == "dct") {
    needs(basis.kind() == DirectionBasis::LatLong && basis.columns() % kDctBlock == 0 &&
              basis.rows() % kDctBlock == 0,
          "lat-long:WxH with multiples of 8");
    return Dct;
  }
  if (name == "haar") {
    needs(basis.kind() == DirectionBasis::Cube && std::has_single_bit(unsigned(basis.columns())),
          "cube:N with a power of two");
    return Haar;
  }
  throwInput("--domain: `{}` is unknown; {}", name,
             didYouMean(name, {"auto", "pixel", "dct", "haar", "sh"}));
}

void transform(std::span<Rgb> values, const DirectionBasis& basis, RelightDomain domain) {
  if (domain == RelightDomain::Dct) return dctForward(values, basis.columns(), basis.rows());
  if (domain != RelightDomain::Haar) return;
  const size_t face = values.size() / 6;
  for (size_t first = 0; first < values.size(); first += face)
    haarForward(values.subspan(first, face), basis.columns());
}

void transform(LightStage& stage, RelightDomain domain) {
  if (domain == RelightDomain::Pixel || domain == RelightDomain::Sh) return;
  const auto count = size_t(stage.basis.size());
  forRows(stage.width(), stage.height(), 3 * count, [&](int y) {
    std::vector<Rgb> values(count);
    for (int x = 0; x < stage.width(); ++x) {
      float* elements = stage.elements.at(x, y);
      for (size_t i = 0; i < count; ++i)
        values[i] = {elements[3 * i], elements[3 * i + 1], elements[3 * i + 2]};
      transform(values, stage.basis, domain);
      for (size_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) elements[3 * i + size_t(c)] = values[i][c];
    }
  });
}

double keepLargest(std::span<float> values, double share) {
  std::vector<uint64_t> counts(kBins);
  for (const float value : values) ++counts[binOf(value)];
  // Bins from the largest down, while they fit; never zeros, which need not be kept.
  const auto most = uint64_t(share * double(values.size()) + 0.5);
  uint64_t kept = 0;
  size_t least = kBins;
  while (least > 0 && kept + counts[least - 1] <= most) kept += counts[--least];
  uint64_t zeros = 0;
  for (float& value : values) {
    if (binOf(value) < least) value = 0;
    zeros += value == 0;
  }
  return double(zeros) / double(std::max<size_t>(values.size(), 1));
}

Image weightedSum(const Image& elements, std::span<const Rgb> weights) {
  std::vector<float> flat;
  for (const Rgb& weight : weights) flat.insert(flat.end(), {weight.x, weight.y, weight.z});
  Image sum(elements.width, elements.height, 3);
  forRows(sum.width, sum.height, flat.size(), [&](int y) {
    for (int x = 0; x < sum.width; ++x)
      sum.setRgb(x, y, product(elements.at(x, y), flat.data(), flat.size()));
  });
  return sum;
}

void addOwnLight(Image& sum, const LightStage& stage) {
  for (size_t i = 0; i < stage.own.texels.size(); ++i) sum.texels[i] += stage.own.texels[i];
}

double relativeDifference(const Image& part, const Image& whole) {
  double differences = 0, squares = 0;
  for (size_t i = 0; i < whole.texels.size(); ++i) {
    const double difference = double(part.texels[i]) - double(whole.texels[i]);
    differences += difference * difference;
    squares += double(whole.texels[i]) * double(whole.texels[i]);
  }
  return squares > 0 ? std::sqrt(differences / squares) : 0;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/relight.h"

#include <array>
#include <bit>

#include "base/error.h"
#include "base/parallel.h"
#include "base/suggest.h"
#include "relight/stage/transforms.h"

namespace chromeball {
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

// Eight partial sums for each channel.
Rgb product(std::span<const float> values, std::span<const float> weights) {
  constexpr size_t kLanes = 24;
  std::array<float, kLanes> sums{};
  const size_t count = weights.size();
  size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (size_t k = 0; k < kLanes; ++k) sums[k] += values[i + k] * weights[i + k];
  for (; i < count; ++i) sums[i % 3] += values[i] * weights[i];
  Rgb total(0);
  for (size_t k = 0; k < kLanes; k += 3) total += Rgb(sums[k], sums[k + 1], sums[k + 2]);
  return total;
}

Image weightedSum(const Image& elements, std::span<const Rgb> weights) {
  const std::span<const float> flat = floatsOf(weights);
  Image sum(elements.width, elements.height, 3);
  forRows(sum.width, sum.height, flat.size(), [&](int y) {
    for (int x = 0; x < sum.width; ++x)
      sum.setRgb(x, y, product({elements.at(x, y), flat.size()}, flat));
  });
  return sum;
}

void addOwnLight(Image& sum, const Image& own) {
  for (size_t i = 0; i < own.texels.size(); ++i) sum.texels[i] += own.texels[i];
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

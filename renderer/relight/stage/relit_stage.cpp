// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/relit_stage.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "relight/stage/transforms.h"

namespace chromeball {

RelightDomain parseDomain(const std::string& name, const DirectionBasis& basis) {
  using enum RelightDomain;
  const bool isSh = !basis.hasCells();
  const auto needs = [&](bool holds, const char* what) {
    if (!holds) throwInput("domain {}: needs {}; this stage has {}", name, what, basis.name());
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
  throwInput("domain: `{}` is unknown; {}", name,
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

namespace {

// Calls visit(x, y, numbers) for each pixel, with a copy of its elements in the domain.
template <class Visit>
void forPixels(const LightStage& band, RelightDomain domain, const Visit& visit) {
  const size_t count = size_t(band.elements.channels);
  forRows(band.width(), band.height(), count, [&](int y) {
    std::vector<Rgb> pixel(count / 3);
    const std::span<float> numbers = floatsOf(pixel);
    for (int x = 0; x < band.width(); ++x) {
      std::copy_n(band.elements.at(x, y), count, numbers.data());
      transform(pixel, band.basis, domain);
      visit(x, y, numbers);
    }
  });
}

size_t leastBinOf(StageBands& stage, RelightDomain domain, double share) {
  PerThread<Magnitudes> parts;
  stage.forEach([&](const LightStage& band, int) {
    forPixels(band, domain,
              [&](int, int, std::span<const float> numbers) { parts.local().add(numbers); });
  });
  Magnitudes all;
  parts.forEach([&](const Magnitudes& part) { all.add(part); });
  return all.leastBin(share);
}

void copyRows(const Image& rows, int top, Image& image) {
  std::ranges::copy(rows.texels, image.at(0, top));
}

}  // namespace

RelitStage relitStage(StageBands& stage, const std::vector<Rgb>& weights, RelightDomain domain,
                      const KeptShares& kept) {
  RelitStage relit;
  std::vector<Rgb> light = weights;
  transform(light, stage.basis(), domain);
  if (kept.light < 1) relit.lightZeros = keepLargest(floatsOf(light), kept.light);
  const size_t leastBin = kept.stage < 1 ? leastBinOf(stage, domain, kept.stage) : 0;

  const auto black = [&] { return Image(stage.width(), stage.height(), 3); };
  Image whole = kept.isAll() ? Image() : black(), own;
  relit.picture = black();
  std::atomic<uint64_t> zeros = 0;
  stage.forEach([&](const LightStage& band, int top) {
    forPixels(band, domain, [&](int x, int y, std::span<float> numbers) {
      if (kept.stage < 1) zeros += dropBelow(leastBin, numbers);
      relit.picture.setRgb(x, top + y, product(numbers, floatsOf(std::as_const(light))));
    });
    if (!kept.isAll()) copyRows(weightedSum(band.elements, weights), top, whole);
    if (!band.own.empty()) {
      if (own.empty()) own = black();
      copyRows(band.own, top, own);
    }
  });
  if (kept.stage < 1)
    relit.zeros = double(zeros) / (3. * stage.basis().size() * stage.width() * stage.height());
  if (!kept.isAll()) relit.error = relativeDifference(relit.picture, whole);
  addOwnLight(relit.picture, own);
  return relit;
}

// The pictures from all numbers and from the kept ones, the scene's own light, and two copies to
// write; and a histogram for each thread and for all.
double relitStageBytes(int width, int height) {
  return 5. * sizeof(Rgb) * width * height +
         (std::thread::hardware_concurrency() + 2.) * double(Magnitudes::kBytes);
}

void Magnitudes::add(const Magnitudes& other) {
  for (size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

size_t Magnitudes::leastBin(double share) const {
  const uint64_t all = std::accumulate(counts_.begin(), counts_.end(), uint64_t(0));
  const auto most = uint64_t(share * double(all) + 0.5);
  uint64_t kept = 0;
  size_t least = counts_.size();
  while (least > 0 && kept + counts_[least - 1] <= most) kept += counts_[--least];
  while (least > 0 && kept == 0) kept += counts_[--least];  // never nothing
  return least;
}

uint64_t dropBelow(size_t leastBin, std::span<float> values) {
  uint64_t zeros = 0;
  for (float& value : values) {
    if (Magnitudes::binOf(value) < leastBin) value = 0;
    zeros += value == 0;
  }
  return zeros;
}

double keepLargest(std::span<float> values, double share) {
  Magnitudes all;
  all.add(values);
  return double(dropBelow(all.leastBin(share), values)) /
         double(std::max<size_t>(values.size(), 1));
}

}  // namespace chromeball

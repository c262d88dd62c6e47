// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/relit_stage.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <utility>

#include "base/parallel.h"

namespace chromeball {
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

// The pictures of all and of what is kept, the scene's own light, and two copies to write; and a
// histogram for each thread and for all.
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

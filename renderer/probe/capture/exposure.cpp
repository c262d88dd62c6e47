// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/error.h"
#include "math/cdf.h"

namespace chromeball {
namespace {

// The transmissions of the apertures in use, relative to f/1.
class Transmissions {
 public:
  explicit Transmissions(std::span<const CameraSettings> photographs) {
    for (const CameraSettings& photograph : photographs)
      if (photograph.aperture && !find(*photograph.aperture))
        entries_.push_back({*photograph.aperture, std::pow(*photograph.aperture, -2)});
  }

  double of(double aperture) const {
    return std::ranges::find_if(
               entries_,
               [&](const Entry& entry) { return isSameAperture(entry.aperture, aperture); })
        ->transmission;
  }

  void apply(const ApertureRatio& ratio) {
    Entry *from = find(ratio.from), *to = find(ratio.to);
    for (const auto& [entry, number] : {std::pair{from, ratio.from}, {to, ratio.to}})
      if (!entry) throwInput("aperture ratio: no photograph was taken at f/{:g}", number);
    if (to->isUsed || from == to)
      throwInput(
          "aperture ratio: {:g}:{:g} changes f/{:g}, which another ratio has used; give the "
          "ratios in a row, as in 4:8=4.1 8:16=4.2",
          ratio.from, ratio.to, ratio.to);
    to->transmission = from->transmission / ratio.ratio;
    from->isUsed = to->isUsed = true;
  }

 private:
  struct Entry {
    double aperture, transmission;
    bool isUsed = false;
  };

  Entry* find(double aperture) {
    const auto found = std::ranges::find_if(
        entries_, [&](const Entry& entry) { return isSameAperture(entry.aperture, aperture); });
    return found == entries_.end() ? nullptr : &*found;
  }

  std::vector<Entry> entries_;
};

}  // namespace

std::vector<double> exposureFactors(std::span<const CameraSettings> photographs,
                                    std::span<const ApertureRatio> ratios) {
  Transmissions transmissions(photographs);
  for (const ApertureRatio& ratio : ratios) transmissions.apply(ratio);
  std::vector<double> factors;
  for (const CameraSettings& p : photographs)
    factors.push_back(p.time * p.iso.value_or(100) / 100 *
                      (p.aperture ? transmissions.of(*p.aperture) : 1));
  return factors;
}

int sampleStep(const Image& image) {
  constexpr double kSamples = 1 << 20;
  return std::max(1, int(std::sqrt(double(image.width) * image.height / kSamples)));
}

namespace {

constexpr size_t kMinPixels = 20;

// The exposures of white at which pixels are compared.
constexpr double kDarkest = 0.01, kBrightest = 0.85;

// The median of found / given.
double medianRatio(const Exposure& longer, const Exposure& shorter, const ResponseCurve& response,
                   int channel, size_t& pixels) {
  const double white = response.logExposure(channel, 1);
  const double low = white + std::log(kDarkest * longer.factor[channel] / shorter.factor[channel]);
  const double high = white + std::log(kBrightest);
  const int step = sampleStep(longer.levels);
  std::vector<double> ratios;
  for (int y = step / 2; y < longer.levels.height; y += step)
    for (int x = step / 2; x < longer.levels.width; x += step) {
      const float ofLonger = longer.levels.at(x, y)[channel];
      const float ofShorter = shorter.levels.at(x, y)[channel];
      if (hatWeight(ofLonger) == 0 || hatWeight(ofShorter) == 0) continue;
      const double a = response.logExposure(channel, ofLonger);
      const double b = response.logExposure(channel, ofShorter);
      if (!(a >= low && a <= high)) continue;
      double flat = 0;
      if (longer.flatField) flat += std::log(longer.flatField->at(x, y)[channel]);
      if (shorter.flatField) flat -= std::log(shorter.flatField->at(x, y)[channel]);
      ratios.push_back(a - b - flat);
    }
  pixels = std::min(pixels, ratios.size());
  if (ratios.size() < kMinPixels) return std::numeric_limits<double>::quiet_NaN();
  return std::exp(median(std::move(ratios))) * shorter.factor[channel] / longer.factor[channel];
}

}  // namespace

std::optional<double> ExposureAgreement::error() const {
  std::optional<double> largest;
  for (int c = 0; c < 3; ++c)
    if (const double difference = std::abs(found[c] - 1); difference >= largest.value_or(0))
      largest = difference;
  return largest;
}

std::vector<ExposureAgreement> exposureAgreement(std::span<const Exposure> exposures,
                                                 const ResponseCurve& response) {
  std::vector<size_t> order(exposures.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::ranges::stable_sort(
      order, [&](size_t a, size_t b) { return exposures[a].factor.y > exposures[b].factor.y; });
  std::vector<ExposureAgreement> agreements;
  for (size_t i = 0; i + 1 < order.size(); ++i) {
    const Exposure &longer = exposures[order[i]], &shorter = exposures[order[i + 1]];
    ExposureAgreement agreement{order[i], order[i + 1], longer.factor.y / shorter.factor.y,
                                dvec3(0), std::numeric_limits<size_t>::max()};
    for (int c = 0; c < 3; ++c)
      agreement.found[c] = medianRatio(longer, shorter, response, c, agreement.pixels);
    agreements.push_back(agreement);
  }
  return agreements;
}

}  // namespace chromeball

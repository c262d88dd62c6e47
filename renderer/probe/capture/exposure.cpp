// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/exposure.h"

#include <limits>
#include <numeric>

#include "base/error.h"
#include "math/cdf.h"
#include "math/dense_solvers.h"

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

  double of(double aperture) { return find(aperture)->transmission; }

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

constexpr size_t kMinPixels = 20;

// Pixels are compared between these exposures, as fractions of white's.
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

constexpr int kLevels = ResponseCurve::kLevels, kMiddle = 128;
constexpr const char* kChannels[] = {"red", "green", "blue"};

int levelOf(float texel) { return int(std::lround(std::clamp(texel, 0.0f, 1.0f) * (kLevels - 1))); }
double weightOf(int level) { return hatWeight(float(level) / (kLevels - 1)); }

// Without the pixels' radiances L, the paper's unknowns: the sum over the exposures j of
// w_j^2 (g_j - ln L - ln k_j)^2 is least, over ln L, at the sum over pairs of
// w_i^2 w_j^2 / (sum of w^2) (g_i - g_j - (ln k_i - ln k_j))^2.
class PixelEquations {
 public:
  PixelEquations(std::span<const Exposure> exposures, int channel) {
    const Image& first = exposures.front().levels;
    const int step = sampleStep(first);
    std::vector<int> levels(exposures.size());
    std::vector<double> logFactors(exposures.size());
    for (int y = step / 2; y < first.height; y += step)
      for (int x = step / 2; x < first.width; x += step) {
        for (size_t i = 0; i < levels.size(); ++i) {
          levels[i] = levelOf(exposures[i].levels.at(x, y)[channel]);
          logFactors[i] = std::log(exposures[i].factor[channel]);
          if (const Image* flat = exposures[i].flatField)
            logFactors[i] += std::log(flat->at(x, y)[channel]);
        }
        add(levels, logFactors);
      }
  }

  double weight() const { return weight_; }
  LeastSquares& equations() { return equations_; }

 private:
  void add(const std::vector<int>& levels, const std::vector<double>& logFactors) {
    double sum = 0;
    for (const int level : levels) sum += weightOf(level) * weightOf(level);
    if (sum == 0) return;
    for (size_t i = 0; i < levels.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const double product = weightOf(levels[i]) * weightOf(levels[j]);
        if (product == 0 || levels[i] == levels[j]) continue;
        const LeastSquares::Term row[] = {{levels[i], 1}, {levels[j], -1}};
        equations_.add(row, logFactors[i] - logFactors[j], product * product / sum);
        weight_ += product * product / sum;
      }
  }

  LeastSquares equations_{kLevels};
  double weight_ = 0;
};

// The curve g of one channel.
std::vector<double> solveChannel(std::span<const Exposure> exposures, int channel,
                                 double smoothness) {
  PixelEquations pixels(exposures, channel);
  LeastSquares& equations = pixels.equations();
  for (int level = 1; level + 1 < kLevels; ++level) {
    const double hat = 2. * std::min(level, kLevels - 1 - level) / (kLevels - 1);
    const LeastSquares::Term row[] = {{level - 1, 1}, {level, -2}, {level + 1, 1}};
    equations.add(row, 0, std::pow(smoothness * hat, 2) * pixels.weight() / kLevels);
  }
  const LeastSquares::Term middle[] = {{kMiddle, 1}};
  equations.add(middle, ResponseCurve::srgb().logExposure(channel, kMiddle / double(kLevels - 1)),
                pixels.weight() / kLevels);
  const auto curve = equations.solve();
  if (pixels.weight() == 0 || !curve)
    throwInput(
        "response solve: no pixel is well exposed in two of the photographs in {}; give more "
        "exposures in between, or the response",
        kChannels[channel]);
  return *curve;
}

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

ResponseCurve solveResponse(std::span<const Exposure> exposures, double smoothness) {
  std::vector<dvec3> table(kLevels);
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<double> curve = solveChannel(exposures, channel, smoothness);
    for (int level = 0; level < kLevels; ++level) {
      table[size_t(level)][channel] = curve[size_t(level)];
      if (level > 0 && !(curve[size_t(level)] > curve[size_t(level) - 1]))
        throwInput(
            "response solve: the photographs fit no response: exposure in {} would not rise from "
            "level {} to {}; are the exposures right, and the camera and the scene still?",
            kChannels[channel], level - 1, level);
    }
  }
  return ResponseCurve(std::move(table));
}

}  // namespace chromeball

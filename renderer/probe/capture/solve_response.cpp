// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/solve_response.h"

#include <cmath>

#include "base/error.h"
#include "math/dense_solvers.h"

namespace chromeball {
namespace {

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
    for (const Exposure& exposure : exposures)
      logFactors_.push_back(std::log(exposure.factor[channel]));
    const Image& first = exposures.front().levels;
    const int step = sampleStep(first);
    std::vector<int> levels(exposures.size());
    for (int y = step / 2; y < first.height; y += step)
      for (int x = step / 2; x < first.width; x += step) {
        for (size_t i = 0; i < levels.size(); ++i)
          levels[i] = levelOf(exposures[i].levels.at(x, y)[channel]);
        add(levels);
      }
  }

  double weight() const { return weight_; }
  LeastSquares& equations() { return equations_; }

 private:
  void add(const std::vector<int>& levels) {
    double sum = 0;
    for (const int level : levels) sum += weightOf(level) * weightOf(level);
    if (sum == 0) return;
    for (size_t i = 0; i < levels.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const double product = weightOf(levels[i]) * weightOf(levels[j]);
        if (product == 0 || levels[i] == levels[j]) continue;
        const LeastSquares::Term row[] = {{levels[i], 1}, {levels[j], -1}};
        equations_.add(row, logFactors_[i] - logFactors_[j], product * product / sum);
        weight_ += product * product / sum;
      }
  }

  std::vector<double> logFactors_;
  LeastSquares equations_{kLevels};
  double weight_ = 0;
};

// g of one channel.
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

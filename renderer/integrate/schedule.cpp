// SPDX-License-Identifier: Apache-2.0
#include "integrate/schedule.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

constexpr uint32_t kFirstPass = 4;        // samples per pixel
constexpr uint32_t kMinForNoise = 16;     // samples per pixel before an estimate of noise is used
constexpr uint32_t kMaxInTheDark = 4096;  // samples per pixel before a black image is final
constexpr double kMinGrowth = 1.0 / 16;   // of a pass, relative to the samples before it

}  // namespace

Schedule::Schedule(const RenderSettings& settings) : settings_(settings) {}

uint32_t Schedule::next(uint32_t done, const Film& film) {
  if (done == 0) return std::min(kFirstPass, settings_.samples);
  double wanted = std::min(2.0 * done, double(settings_.samples));
  if (settings_.timeLimit) wanted = std::min(wanted, untilTime(done));
  if (settings_.noiseLimit && done >= kMinForNoise)
    wanted = std::min(wanted, untilNoise(done, film));
  return uint32_t(wanted);
}

double Schedule::progress(double samples) const {
  if (settings_.timeLimit) return std::min(1.0, elapsed_.seconds() / *settings_.timeLimit);
  if (settings_.noiseLimit) return std::nan("");
  return samples / settings_.samples;
}

double Schedule::untilTime(uint32_t done) const {
  const double affordable = done * *settings_.timeLimit / elapsed_.seconds();
  return affordable < done * (1 + kMinGrowth) ? 0 : affordable;
}

// Noise is proportional to samples^-rate; rate is 1/2 for independent samples, up to 1 for
// quasi-random ones.
double Schedule::untilNoise(uint32_t done, const Film& film) {
  const Noise noise = film.noise();
  if (std::isnan(noise.noise)) return done < kMaxInTheDark ? INFINITY : 0;
  const double excess = noise.upper / *settings_.noiseLimit;
  if (excess <= 1) return 0;
  double rate = 0.5;
  if (last_.samples > 0 && noise.noise < last_.noise)
    rate = std::log(last_.noise / noise.noise) / std::log(double(done) / last_.samples);
  last_ = {done, noise.noise};
  return done * std::max(std::pow(excess, 1 / std::clamp(rate, 0.5, 1.0)), 1 + kMinGrowth);
}

}  // namespace chromeball

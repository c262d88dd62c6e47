// SPDX-License-Identifier: Apache-2.0
#include "render/schedule.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

constexpr uint32_t kFirstPass = 4;      // samples per pixel
constexpr uint32_t kLeastOfShard = 16;  // samples per pixel besides those that it repeats
constexpr uint32_t kMinForNoise = 16;   // samples per pixel before an estimate of noise is used
constexpr uint32_t kMinToAdapt = 16;    // samples per pixel of an adaptive render
constexpr double kPilot = 16;           // samples per pixel of the pilot of an adaptive render;
constexpr double kMinPilot = 1.0 / 8, kMaxPilot = 1.0 / 4;  // relative to the whole render
constexpr double kRepeatedPilot = 1.0 / 16;  // at least, of one that all shards repeat
constexpr uint32_t kMaxInTheDark = 4096;     // samples per pixel before a black image is final
constexpr double kMinGrowth = 1.0 / 16;      // of a pass, relative to the samples before it

}  // namespace

uint32_t Schedule::pilotSamples(const RenderSettings& settings) {
  if (!settings.adaptive || settings.samples < kMinToAdapt) return 0;
  const bool isOpen = settings.timeLimit || settings.noiseLimit;
  const double samples = settings.samples, least = isOpen ? 0 : kRepeatedPilot * samples;
  return uint32_t(std::clamp(kPilot, least, kMaxPilot * samples));
}

Schedule::Schedule(const RenderSettings& settings)
    : settings_(settings), pilot_(settings.adaptive && settings.samples >= kMinToAdapt) {}

uint32_t Schedule::next(uint32_t done, const Film& film) {
  if (done == 0) return std::min(kFirstPass, settings_.samples);
  const double goal = goalAfter(done, film);
  double wanted = std::min(2.0 * done, goal);
  const double repeated = settings_.shard.repeated;
  const double pilot =
      repeated > 0 ? repeated : std::floor(std::clamp(kPilot, kMinPilot * goal, kMaxPilot * goal));
  endsPilot_ = pilot_ && done >= pilot && goal >= kMinToAdapt;
  pilot_ = pilot_ && !endsPilot_;
  if (pilot_ && pilot > done) wanted = std::min(wanted, pilot);
  if (repeated > done) wanted = std::min(wanted, repeated);
  return uint32_t(wanted);
}

uint32_t Schedule::leastSamples() const {
  const Shard& shard = settings_.shard;
  const bool repeats = shard.index > 0 && shard.repeated > 0;
  return std::min(repeats ? shard.repeated + kLeastOfShard : kFirstPass, settings_.samples);
}

// The number of samples per pixel at which the render ends, as far as is known.
double Schedule::goalAfter(uint32_t done, const Film& film) {
  const uint32_t least = leastSamples();
  if (done < least) return least;
  double goal = settings_.samples;
  if (settings_.timeLimit) goal = std::min(goal, untilTime(done));
  if (settings_.noiseLimit && done >= kMinForNoise) {
    goal = std::min(goal, untilNoise(done, film));
    goal_ = goal;
  }
  return goal;
}

double Schedule::overrun(uint32_t done) const {
  const bool isLeast = done <= leastSamples();
  return settings_.timeLimit && isLeast && seconds() > *settings_.timeLimit ? seconds() : 0;
}

double Schedule::progress(double samples) const {
  if (settings_.timeLimit) return std::min(1.0, seconds() / *settings_.timeLimit);
  if (!settings_.noiseLimit) return samples / settings_.samples;
  return std::isfinite(goal_) && goal_ > 0 ? std::min(1.0, samples / goal_) : std::nan("");
}

double Schedule::untilTime(uint32_t done) const {
  const double affordable = done * *settings_.timeLimit / seconds();
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
    rate = std::log(last_.noise / noise.noise) / std::log(double(done) / double(last_.samples));
  last_ = {done, noise.noise};
  return done * std::max(std::pow(excess, 1 / std::clamp(rate, 0.5, 1.0)), 1 + kMinGrowth);
}

void Schedule::archive(Archive& a, bool adapts) {
  double elapsed = seconds();
  a(elapsed);
  a(last_);
  if (!a.reads()) return;
  before_ = elapsed;
  pilot_ = pilot_ && !adapts;
}

}  // namespace chromeball

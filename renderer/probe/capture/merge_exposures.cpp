// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/merge_exposures.h"

#include <cmath>
#include <mutex>

#include "base/parallel.h"

namespace chromeball {
namespace {

struct Channel {
  enum class State { Measured, Clipped, Underexposed } state = State::Measured;
  double radiance = 0;
};

class Merger {
 public:
  Merger(std::span<const Exposure> exposures, const ResponseCurve& response)
      : exposures_(exposures), response_(response) {}

  Channel merge(int x, int y, int channel) const {
    double sum = 0, weights = 0;
    for (const Exposure& exposure : exposures_) {
      const float level = exposure.levels.at(x, y)[channel], weight = hatWeight(level);
      if (weight == 0) continue;
      sum += weight * logRadiance(exposure, x, y, channel, level);
      weights += weight;
    }
    if (weights > 0) return {Channel::State::Measured, std::exp(sum / weights)};
    return bound(x, y, channel);
  }

 private:
  double logRadiance(const Exposure& exposure, int x, int y, int channel, float level) const {
    const double flat = exposure.flatField ? exposure.flatField->at(x, y)[channel] : 1;
    return response_.logExposure(channel, level) - std::log(exposure.factor[channel] * flat);
  }

  // The highest of the bounds is that of the shortest exposure.
  Channel bound(int x, int y, int channel) const {
    Channel bound{Channel::State::Underexposed, 0};
    for (const Exposure& exposure : exposures_)
      if (exposure.levels.at(x, y)[channel] >= kSaturated)
        bound = {
            Channel::State::Clipped,
            std::max(bound.radiance, std::exp(logRadiance(exposure, x, y, channel, kSaturated)))};
    return bound;
  }

  std::span<const Exposure> exposures_;
  const ResponseCurve& response_;
};

// Adds those of one row.
void count(std::span<const Exposure> exposures, int y, std::vector<MergedExposures::Use>& uses) {
  for (size_t i = 0; i < exposures.size(); ++i)
    for (int x = 0; x < exposures[i].levels.width; ++x) {
      const Rgb levels = exposures[i].levels.rgb(x, y);
      uses[i].saturated += maxComponent(levels) >= kSaturated;
      uses[i].weighted += hatWeight(levels.x) + hatWeight(levels.y) + hatWeight(levels.z) > 0;
    }
}

}  // namespace

MergedExposures mergeExposures(std::span<const Exposure> exposures, const ResponseCurve& response) {
  const int width = exposures.front().levels.width, height = exposures.front().levels.height;
  MergedExposures merged{.radiance = Image(width, height, 3),
                         .clipped = Image(width, height, 1),
                         .uses = std::vector<MergedExposures::Use>(exposures.size())};
  const Merger merger(exposures, response);
  std::mutex mutex;  // of the counts
  forRows(width, height, [&](int y) {
    size_t clipped = 0, underexposed = 0;
    for (int x = 0; x < width; ++x) {
      bool isClipped = false, isUnderexposed = false;
      for (int c = 0; c < 3; ++c) {
        const Channel channel = merger.merge(x, y, c);
        merged.radiance.at(x, y)[c] = float(channel.radiance);
        isClipped |= channel.state == Channel::State::Clipped;
        isUnderexposed |= channel.state == Channel::State::Underexposed;
      }
      *merged.clipped.at(x, y) = isClipped ? 1 : 0;
      clipped += isClipped;
      underexposed += isUnderexposed;
    }
    const std::lock_guard lock(mutex);
    merged.clippedPixels += clipped;
    merged.underexposedPixels += underexposed;
    count(exposures, y, merged.uses);
  });
  return merged;
}

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Image size, sampling limits and path settings of a render.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "film/aov.h"
#include "integrate/path_settings.h"

namespace chromeball {

// Of light samples and bounces (guide_training.h). `Auto` guides if that is worth its time;
// `On` guides light samples wherever that reduces their variance, and bounces always.
enum class Guiding { Off, On, Auto };

// The part of an image that a render takes, in pixels.
struct Crop {
  int x, y, width, height;
};

// One of `count` equal shares of the samples of a render, each of which is a render of its own. Its
// samples are those of the whole render that the other shares do not take.
struct Shard {
  uint32_t index = 0, count = 1;
  uint32_t samplesOfAll = 0;  // per pixel; 0 for a render that is not a shard

  // The first sample of a pixel that is this shard's; even, so that both halves have equal shares.
  uint32_t first() const { return firstOf(index); }
  uint32_t samples() const {
    return (index + 1 == count ? samplesOfAll : firstOf(index + 1)) - first();
  }

 private:
  uint32_t firstOf(uint32_t i) const {
    return uint32_t(uint64_t(samplesOfAll) * i / count) & ~uint32_t(1);
  }
};

struct RenderSettings {
  int width = 800, height = 600;  // of the whole image
  std::optional<Crop> crop;
  Shard shard;
  uint32_t samples = 256;  // per pixel, of this shard, >= 1; the maximum where a limit below is set
  std::optional<double> timeLimit;   // seconds
  std::optional<double> noiseLimit;  // fraction (film/noise.h)
  // More samples in noisier pixels, from 16 on; `samples` is then the mean (film/allocation.h).
  bool adaptive = true;
  Guiding guiding = Guiding::Auto;
  int maxDepth = 8;  // as in PathSettings, like maxTransmissionDepth
  int maxTransmissionDepth = kDefaultTransmissionDepth;
  Mis mis = Mis::Balance;
  uint64_t seed = 0;
  bool hideProbe = false;      // from the camera
  std::optional<float> clamp;  // largest value of a channel of a sample; nullopt: no limit
  std::vector<Aov> aovs;
  bool regularize = false;  // biased: see regularization.h; the World needs tables for it
  bool denoise = false;     // the render keeps what denoise() needs (RenderResult::features)

  // Per pixel, of all shards together.
  uint32_t samplesOfAll() const { return shard.count > 1 ? shard.samplesOfAll : samples; }
  // Whether the image is put together from several renders (job/merge.h).
  bool isPart() const { return crop || shard.samplesOfAll > 0; }
  bool denoisesAtEnd() const { return denoise && !isPart(); }  // a part: when it is merged
  Crop window() const { return crop.value_or(Crop{0, 0, width, height}); }

  bool wantsFeatures() const {
    return denoise || std::find(aovs.begin(), aovs.end(), Aov::Denoise) != aovs.end();
  }
  PathSettings path() const {
    return {.mis = mis,
            .maxDepth = maxDepth,
            .maxTransmissionDepth = maxTransmissionDepth,
            .hideProbe = hideProbe};
  }
};

}  // namespace chromeball

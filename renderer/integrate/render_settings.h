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

struct RenderSettings {
  int width = 800, height = 600;
  uint32_t samples = 256;            // per pixel, >= 1; the maximum where a limit below is set
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

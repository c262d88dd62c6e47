// SPDX-License-Identifier: Apache-2.0
// Image size, sampling limits and path settings of a render.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "approximate/occlusion.h"
#include "base/archive.h"
#include "film/aov.h"
#include "transport/path_settings.h"

namespace chromeball {

// One of several renders whose samples together make up one render's.

struct RenderSettings;

// Without adaptive sampling and guides, the samples of a shard are consecutive ones of the whole
// render's. Otherwise every shard takes the first samples of the whole render, and learns from them
// what the whole render would learn: how samples are allotted, and the guides. The first shard
// keeps these samples. Shard k of n keeps the k-th, the (k + n)-th, the (k + 2 n)-th, ... of the
// later samples of a pixel's half.
struct Shard {
  uint32_t index = 0, count = 1;
  uint32_t samplesOfAll = 0;  // mean per pixel; 0 for a render that is not a shard
  uint32_t repeated = 0;      // samples per pixel that all shards take; 0: none
  bool isConsecutive = true;  // samples of a half; else every count-th

  void archive(Archive& a);

  // The mean samples per pixel of all shards when this one has taken `taken`; `taken` itself if the
  // samples are consecutive.
  uint32_t ofAll(uint32_t taken) const;
  // The mean samples per pixel, of `taken`, that this shard keeps.
  uint32_t kept(uint32_t taken) const;

  // The first of a pixel's samples if they are consecutive; even, so that both halves have equal
  // shares.
  uint32_t first() const { return firstOf(index); }
  // The number of samples per pixel that the shard takes.
  uint32_t samples() const;

 private:
  uint32_t firstOf(uint32_t i) const {
    return uint32_t(uint64_t(samplesOfAll) * i / count) & ~uint32_t(1);
  }
};

// The settings of shard `index` of `count` of a render.
RenderSettings shardOf(RenderSettings whole, uint32_t index, uint32_t count);

// The integrators by name.

enum class IntegratorKind {
  Path,
  Direct,            // paths of one bounce
  AmbientOcclusion,  // environment mapping with both kinds of occlusion
  EnvironmentMap,
};

// Names, in the order of IntegratorKind.
inline constexpr std::array<std::string_view, 4> kIntegratorNames = {
    "path", "direct", "ambient-occlusion", "environment-map"};

// Whether it takes the probe's light from prefiltered maps (environment_map.h).
constexpr bool usesEnvironment(IntegratorKind kind) {
  return kind == IntegratorKind::AmbientOcclusion || kind == IntegratorKind::EnvironmentMap;
}

// Guiding of light samples and bounces (guide_training.h). `Auto` guides if that is worth its time;
// `On` guides light samples wherever that reduces their variance, and bounces always.
enum class Guiding { Off, On, Auto };

// The part of an image that a render takes, in pixels.
struct Crop {
  int x, y, width, height;
};

// The largest number that a user may give.
inline constexpr uint32_t kMaxSamples = 2'000'000'000;
inline constexpr int kMaxDepth = 1'000'000;

// Names of layers that are split by source of light.
inline constexpr std::string_view kLightGroups = "light_groups", kShadowMattes = "shadow_mattes";

inline bool isOfLight(std::string_view layer) {
  return layer == kLightGroups || layer == kShadowMattes;
}

struct RenderSettings {
  int width = 800, height = 600;  // of the whole image
  std::optional<Crop> crop;
  Shard shard;
  // Number per pixel, including those that a shard repeats; >= 1; the maximum where a limit below
  // is set.
  uint32_t samples = 256;
  std::optional<double> timeLimit;   // seconds
  std::optional<double> noiseLimit;  // fraction (film/noise.h)
  // Takes more samples in noisier pixels, from 16 on; `samples` is then the mean (film/noise.h).
  bool adaptive = true;
  Guiding guiding = Guiding::Auto;  // as it was asked for
  int maxDepth = 8;                 // as in PathSettings, like maxTransmissionDepth
  int maxTransmissionDepth = kDefaultTransmissionDepth;
  int maxDiffuseDepth = INT_MAX, maxSpecularDepth = INT_MAX;  // as in PathSettings
  IntegratorKind integrator = IntegratorKind::Path;
  Occlusion occlusion;
  std::optional<float>
      cacheError;  // of approximate/irradiance_cache.h; nullopt: light is not cached
  Mis mis = Mis::Balance;
  uint64_t seed = 0;
  bool hideProbe = false;      // from the camera
  std::optional<float> clamp;  // largest value of a channel of a sample; nullopt: no limit
  std::vector<Aov> aovs;
  bool lightGroups = false, shadowMattes = false;  // layers by source (light_groups.h)
  bool regularize = false;  // biased: see path_settings.h; the World needs tables for it
  bool denoise = false;     // the render keeps what denoise() needs (RenderResult::features)

  // The samples per pixel of all shards together.
  uint32_t samplesOfAll() const { return shard.count > 1 ? shard.samplesOfAll : samples; }
  // Whether the image is put together from several renders (parts/merge.h).
  bool isPart() const { return crop || shard.samplesOfAll > 0; }
  bool denoisesAtEnd() const { return denoise && !isPart(); }  // a part: when it is merged
  Crop window() const { return crop.value_or(Crop{0, 0, width, height}); }

  // The integrator ambient-occlusion is environment mapping with both kinds of occlusion.
  Occlusion usedOcclusion() const {
    Occlusion used = occlusion;
    if (integrator == IntegratorKind::AmbientOcclusion) used.ambient = used.reflection = true;
    return used;
  }
  bool wantsGroups() const { return lightGroups || shadowMattes; }
  bool wantsAov(Aov aov) const { return std::find(aovs.begin(), aovs.end(), aov) != aovs.end(); }
  bool wantsSurfaceLayers() const {
    return wantsAov(Aov::AmbientOcclusion) || wantsAov(Aov::BentNormal) ||
           wantsAov(Aov::Irradiance);
  }
  bool wantsFeatures() const { return denoise || wantsAov(Aov::Denoise); }
  // Without bounces there is nothing to approximate.
  bool usesEnvironmentMaps() const { return usesEnvironment(integrator) && maxDepth > 0; }
  // With fewer bounces no surface lights another.
  bool usesCache() const { return cacheError && path().maxDepth > 1; }
  // Prefiltered maps have no limits of depth, and the light beyond those of cached records is not
  // known.
  bool estimatesDepthCut() const { return !usesEnvironmentMaps() && !usesCache(); }
  PathSettings path() const {
    return {.mis = mis,
            .maxDepth = integrator == IntegratorKind::Direct ? std::min(maxDepth, 1) : maxDepth,
            .maxTransmissionDepth = maxTransmissionDepth,
            .maxDiffuseDepth = maxDiffuseDepth,
            .maxSpecularDepth = maxSpecularDepth,
            .hideProbe = hideProbe};
  }
  // Guided bounces have no kind: with depth limits by kind, nothing is guided.
  Guiding usedGuiding() const { return path().limitsKinds() ? Guiding::Off : guiding; }
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// `suns`: concentrated sources are replaced by discs that are sampled separately; the remainder of
// the probe is sampled as in `importance` (HDRI book, section 9.6.1).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/hash.h"
#include "lighting/importance.h"
#include "lighting/light_source.h"
#include "math/cdf.h"
#include "math/rotation.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "probe/probe.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// The light group of a probe's suns; that of the rest of the probe is "probe".
inline constexpr const char* kSunsGroup = "probe.suns";

// Distant discs of constant radiance, such as suns.

// Samples one direction in each disc, uniform over its solid angle 2 pi (1 - cos(angle / 2)). From
// more than two discs, chooses one with probability proportional to power: with four suns this
// needs 45% fewer rays for the same noise.
class SkyDiscs {
 public:
  // The discs are turned, like a probe.
  explicit SkyDiscs(const std::vector<Sun>& suns, const Rotation& rotation = {});

  bool empty() const { return discs_.empty(); }

  // Calls visit(wi) for each direction. All discs use the same stratified point with different
  // digital shifts, which keep it stratified; `set` tells several lists of discs apart.
  template <class Visit>
  void sample(uint32_t u, uint32_t v, uint64_t set, const Visit& visit) const {
    if (choice_) {
      double position = (u ^ uint32_t(hash(set))) * 0x1p-32;
      const int chosen = choice_->sample(0, position);
      visit(discs_[size_t(chosen)].cap.direction(float(position),
                                                 toUnit(v ^ uint32_t(hash(set + 1)))));
      return;
    }
    for (size_t i = 0; i < discs_.size(); ++i) {
      const uint64_t shift = hash(set + i);
      visit(
          discs_[i].cap.direction(toUnit(u ^ uint32_t(shift)), toUnit(v ^ uint32_t(shift >> 32))));
    }
  }

  // The sum over all discs in a direction; the pdf is that of sample().
  using Light = LightSource::Escaped;
  Light at(const vec3& wi) const {
    Light sum{Rgb(0), 0};
    forDiscsAt(wi, [&](size_t, const Light& disc) { sum += disc; });
    return sum;
  }
  // Calls visit(index of the sun, its Light) for each disc in the direction.
  template <class Visit>
  void forDiscsAt(const vec3& wi, const Visit& visit) const {
    for (size_t i = 0; i < discs_.size(); ++i)
      if (discs_[i].cap.contains(wi)) visit(i, discs_[i].light);
  }

 private:
  struct Disc {
    SphericalCap cap;
    Light light;  // inside this disc
  };

  std::vector<Disc> discs_;
  std::optional<CdfRows> choice_;  // of one disc by power; empty if all are sampled
};

// Takes one stratified sample of each sun, or of one of many, and one of the
// remainder. All rays, including those of the camera and mirrors, see the
// remainder plus the discs, so energy is counted once. The only bias is the shape of the suns,
// visible in highlights and penumbras: a disc with the irradiance and the spread of the source that
// it replaces (probe/sun_extraction.h). (At a pole the interpolation of the last row adds light to
// the probe; discs there have up to 8% less.)
//
// All samples are combined by the balance heuristic: pdfs and radiances of the remainder and all
// discs in a direction are added.
class Suns : public LightSource {
 public:
  // `compensated`: MIS compensation of the remainder (importance.h). `angle`: a diameter for all
  // suns, in degrees, above 0 and at most 90, instead of the measured ones; the Sun's is
  // kSunDiameter (probe/synth.h).
  Suns(const Probe& probe, bool compensated, std::optional<double> angle = {});
  Suns(const Suns&) = delete;

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override;
  // Without suns this is the same as `importance`.
  bool unbiased() const override { return discs_.empty(); }
  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override;
  void splitBackground(const vec3& origin, const vec3& wi, std::span<Rgb> radiances) const override;

 private:
  Suns(SunExtraction extraction, const Rotation& rotation, bool compensated,
       std::optional<double> angle);

  Probe remainder_;
  Importance importance_;
  SkyDiscs discs_;
};

// Wraps a strategy that samples the whole probe: tells its suns and the rest of it apart, as light
// groups.

// Samples and radiances are the strategy's.
class SplitProbe : public WrappedLight {
 public:
  SplitProbe(std::unique_ptr<LightSource> strategy, const Probe& probe);

  void escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const override {
    strategy_->escapedMany(rays, out);
  }
  bool sampleMany(std::span<const glm::uvec2> numbers,
                  std::span<DirectionSample> out) const override {
    return strategy_->sampleMany(numbers, out);
  }
  Rgb background(const vec3& origin, const vec3& wi) const override {
    return strategy_->background(origin, wi);
  }

  std::vector<std::string> groups() const override;
  void splitEscaped(const LightPoint& point, const vec3& wi,
                    std::span<Rgb> radiances) const override {
    split(escaped(point, wi).radiance, wi, radiances);
  }
  void splitBackground(const vec3& origin, const vec3& wi,
                       std::span<Rgb> radiances) const override {
    split(background(origin, wi), wi, radiances);
  }

 private:
  SplitProbe(std::unique_ptr<LightSource> strategy, const SunExtraction& extraction,
             const Rotation& rotation);
  void split(const Rgb& whole, const vec3& wi, std::span<Rgb> radiances) const;

  bool hasSuns_;
  Probe rest_;  // without the suns
};

}  // namespace chromeball

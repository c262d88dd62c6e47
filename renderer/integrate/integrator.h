// SPDX-License-Identifier: Apache-2.0
// Integrators estimate the radiance that arrives along camera rays.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "film/invalid.h"
#include "film/layer_film.h"
#include "integrate/path.h"

namespace chromeball {

// A camera ray through pixel (x, y) and its closest hit. `half`: of the pixel's samples (Film).
struct CameraSample {
  int x, y, half;
  Ray ray;
  std::optional<Hit> hit;
  Beam beam{};                // the ray's footprint, for texture filtering
  float widening = 0;         // as in PathState
  FirstHit* first = nullptr;  // output; null: not wanted

  PathState path() const {
    return {.ray = ray, .widening = widening, .beam = beam, .first = first};
  }
};

// A sample of a pixel. A defect excludes it from the mean.
struct Sample {
  Rgb radiance{0};
  std::optional<Defect> defect;

  Sample() = default;
  Sample(const Rgb& found) : radiance(found), defect(defectOf(found, false)) {}
  Sample(const Rgb& found, std::optional<Defect> cause) : radiance(found), defect(cause) {}
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  // One sample of a pixel. Writes context.layers: one value per layer of layers(), initially 0.
  // Called concurrently, with one context per thread.
  virtual Sample sample(const CameraSample& camera, PathContext& context) const = 0;

  // The same for several samples of a pixel: cameras[i] is sample firstSample + i of the sampler's
  // pixel. Only for integrators without layers.
  virtual void sampleMany(std::span<const CameraSample> cameras, uint32_t firstSample,
                          PathContext& context, std::span<Sample> samples) const {
    for (size_t i = 0; i < cameras.size(); ++i) {
      context.sampler.startSample(firstSample + uint32_t(i));
      samples[i] = sample(cameras[i], context);
    }
  }

  // How the film accumulates each layer (RenderResult::layers).
  virtual std::vector<Accumulation> layers() const { return {}; }

  // The names of the layers, if they are light groups.
  virtual std::vector<std::string> groups() const { return {}; }

  // The instances visible to camera rays.
  virtual RayMask visible() const { return kAllInstances; }
};

// Path tracing of all instances.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const PathTracer& tracer) : tracer_(tracer) {}

  Sample sample(const CameraSample& camera, PathContext& context) const override {
    return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  }

  void sampleMany(std::span<const CameraSample> cameras, uint32_t firstSample, PathContext& context,
                  std::span<Sample> samples) const override;

 private:
  PathTracer tracer_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What a render estimates: light that arrives along camera rays.
#pragma once

#include <optional>
#include <vector>

#include "film/invalid.h"
#include "film/layer_film.h"
#include "integrate/path.h"

namespace chromeball {

// A camera ray through pixel (x, y), and the first surface that it meets.
struct CameraSample {
  int x, y;
  Ray ray;
  std::optional<Hit> hit;
  Beam beam{};                // around the ray, where the scene has textures to filter
  FirstHit* first = nullptr;  // to be filled; null: not wanted

  PathState path() const { return {.ray = ray, .beam = beam, .first = first}; }
};

// A sample of a pixel: radiance, or the defect that excludes it.
struct Sample {
  Rgb radiance{0};
  std::optional<Defect> defect;

  Sample(const Rgb& found) : radiance(found), defect(defectOf(found, false)) {}
  Sample(const Rgb& found, std::optional<Defect> cause) : radiance(found), defect(cause) {}
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  // One sample of a pixel; called concurrently. Fills context.layers, one value for each of
  // layers(), which are 0 at the start.
  virtual Sample sample(const CameraSample& camera, PathContext& context) const = 0;

  // The layers of its samples, which the film gathers (RenderResult::layers).
  virtual std::vector<Accumulation> layers() const { return {}; }

  // The instances that camera rays see.
  virtual RayMask visible() const { return kAllInstances; }
};

// Path tracing of the whole scene.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const PathTracer& tracer) : tracer_(tracer) {}

  Sample sample(const CameraSample& camera, PathContext& context) const override {
    return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  }

 private:
  PathTracer tracer_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// What a render estimates: light that comes along rays from the camera.
#pragma once

#include "film/invalid.h"
#include "integrate/clamp.h"
#include "integrate/path.h"
#include "trace/accel.h"

namespace chromeball {

// A ray through pixel (x, y), and what it meets first.
struct CameraSample {
  int x, y;
  Ray ray;
  std::optional<Hit> hit;
  Beam beam{};  // around the ray, where the scene has textures to filter

  PathState path() const { return {.ray = ray, .beam = beam}; }
};

// What a sample adds to its pixel: radiance, or the reason why it is left out.
struct Sample {
  Rgb radiance{0};
  std::optional<Defect> defect;

  Sample(const Rgb& found) : radiance(found), defect(defectOf(found, false)) {}
  Sample(const Rgb& found, std::optional<Defect> cause) : radiance(found), defect(cause) {}
};

// What a thread needs of its own.
struct PathMemory {
  PixelSampler sampler;  // at the sample that is asked for
  std::vector<DirectionSample> samples;
  RayCounts rays;
  Clamp clamp;  // for the integrator to apply to what it traced
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  // One sample of a pixel. Concurrently for different pixels. `first` may be null.
  virtual Sample sample(const CameraSample& camera, PathMemory& memory, FirstHit* first) const = 0;
};

// Path tracing of the whole scene.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const PathScene<Accel>& path) : path_(path) {}

  Sample sample(const CameraSample& camera, PathMemory& memory, FirstHit* first) const override {
    return memory.clamp(pathRadiance(path_, camera.path(), camera.hit, memory.sampler,
                                     memory.samples, memory.rays, first));
  }

 private:
  const PathScene<Accel>& path_;
};

}  // namespace chromeball

// What a render estimates: light that comes along rays from the camera.
#pragma once

#include "integrate/clamp.h"
#include "integrate/path.h"
#include "trace/accel.h"

namespace chromeball {

// A ray through pixel (x, y), and what it meets first.
struct CameraSample {
  int x, y;
  Ray ray;
  std::optional<Hit> hit;
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

  // Radiance for one sample of a pixel. Concurrently for different pixels. `first` may be null.
  virtual Rgb radiance(const CameraSample& sample, PathMemory& memory, FirstHit* first) const = 0;

  // Whether negative radiance is an answer and no mistake: a difference may be.
  virtual bool isSigned() const { return false; }
};

// Path tracing of the whole scene.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const PathScene<Accel>& path) : path_(path) {}

  Rgb radiance(const CameraSample& sample, PathMemory& memory, FirstHit* first) const override {
    return memory.clamp(pathRadiance(path_, sample.ray, sample.hit, memory.sampler, memory.samples,
                                     memory.rays, first));
  }

 private:
  const PathScene<Accel>& path_;
};

}  // namespace chromeball

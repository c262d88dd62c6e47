// SPDX-License-Identifier: Apache-2.0
// Integrators estimate the radiance that arrives along camera rays.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "film/film.h"
#include "film/layer_film.h"
#include "transport/camera_sample.h"

namespace chromeball {

class CameraSamples;

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

  // One sample of each camera ray, of any pixels. Called concurrently, with one context per thread.
  virtual void sampleMany(const CameraSamples& cameras, PathContext& context,
                          std::span<Sample> samples) const = 0;

  // The number of samples that sampleMany() takes at most.
  virtual size_t batch() const;

  // How the film accumulates each layer (RenderResult::layers).
  virtual std::vector<Accumulation> layers() const { return {}; }

  // The names of the layers, if they are light groups.
  virtual std::vector<std::string> groups() const { return {}; }

  // The instances visible to camera rays.
  virtual RayMask visible() const { return kAllInstances; }
};

// Integrators that estimate one sample at a time.
class SingleIntegrator : public Integrator {
 public:
  void sampleMany(const CameraSamples& cameras, PathContext& context,
                  std::span<Sample> samples) const final;

 protected:
  // The sampler has been started for the sample.
  virtual Sample sample(const CameraSample& camera, PathContext& context) const = 0;
};

// Path tracing of all instances.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const PathTracer& tracer) : tracer_(tracer) {}

  void sampleMany(const CameraSamples& cameras, PathContext& context,
                  std::span<Sample> samples) const override;

  size_t batch() const override;

 private:
  PathTracer tracer_;
};

// Paths that are traced together, a vertex of each at a time: their rays form packets, and their
// reads from the probe's tables and the meshes overlap. Gives the same estimates as
// PathTracer::radiance(). A batch is reused for the next paths, since clearing its arrays would
// take a noticeable part of the time.
class PathBatch {
 public:
  // Unless LightSource::batch() is larger.
  static constexpr size_t kMaxPaths = LightSource::kMaxMany;

  // Traces the paths of camera rays, in lanes where that is possible (wide_paths.h). Returns their
  // radiances, in memory of this thread: valid until its next call.
  static std::span<const Rgb> traced(const CameraSamples& cameras, const PathTracer& tracer,
                                     PathContext& context);

  // The path of a camera ray.
  void add(const CameraSample& camera) { add(camera, camera.path(), camera.hit); }
  // The same from a later vertex on. `hit`: of the state's ray.
  void add(const CameraSample& camera, const PathState& state, const std::optional<Hit>& hit);

  // Traces all paths to their ends, as PathTracer::follow() does.
  void follow(const PathTracer& tracer, PathContext& context);

  // The results, in the order of add().
  const Rgb& radiance(size_t i) const { return paths_[i].radiance; }

  void clear() { count_ = 0; }

 private:
  template <class T>
  struct List {
    std::vector<T> items;
    size_t size = 0;

    void add(const T& item) { items[size++] = item; }
    std::span<T> all() { return std::span(items).first(size); }
    std::span<const T> all() const { return std::span(items).first(size); }
  };
  using Indices = List<uint32_t>;  // of paths
  struct Camera {
    PixelSampler::Sample numbers;
    std::span<Rgb> layers;
  };

  void grow();

  struct Task;
  void select(uint32_t path, Task& task);
  void selectGroups(uint32_t path, Task& task);
  void endEscaped(Task& task);
  void drawLightSamples(Task& task);
  void shade(Task& task);
  void drawWaiting(Task& task);
  void completeGuided(Task& task);
  void traceShadowRays(Task& task);
  void traceNextRays(Task& task);
  void traceLastRays(const Indices& paths, Task& task);

  size_t count_ = 0;
  std::vector<PathState> paths_;
  std::vector<Camera> cameras_;
  std::vector<std::optional<Hit>> hits_;
  std::vector<DeferredLight> lights_;
  Indices active_, shaded_;
  Indices chosen_;  // within each step

  // Arguments and results of the functions that take several rays.
  List<Ray> rays_;
  List<uint32_t> keys_;
  List<LightSource::Escape> escapes_;
  List<LightSource::Sight> sights_;
  List<glm::uvec2> numbers_;
  List<LightPoint> points_;
  std::vector<LightSource::Escaped> escaped_;
  std::vector<Rgb> backgrounds_;
  std::vector<DirectionSample> samples_;
  std::vector<std::optional<Hit>> found_;
  std::vector<Rgb> transmittances_;
};

}  // namespace chromeball

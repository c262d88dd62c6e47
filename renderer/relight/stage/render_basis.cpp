// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/render_basis.h"

#include <array>

#include "base/parallel.h"
#include "transport/camera_samples.h"

namespace chromeball {
namespace {

Image whiteMap() {
  Image map(2, 1, 3);
  std::fill(map.texels.begin(), map.texels.end(), 1.0f);
  return map;
}

RenderSettings plainSettings(const RenderSettings& from) {
  RenderSettings s;
  s.width = from.width, s.height = from.height;
  s.samples = from.samples;
  s.adaptive = false;
  s.guiding = Guiding::Off;
  s.maxDepth = from.maxDepth, s.maxTransmissionDepth = from.maxTransmissionDepth;
  s.maxDiffuseDepth = from.maxDiffuseDepth, s.maxSpecularDepth = from.maxSpecularDepth;
  s.mis = from.mis;
  s.seed = from.seed;
  s.hideProbe = from.hideProbe;
  return s;
}

PathSettings pathSettings(const RenderSettings& from) {
  PathSettings paths = from.path();
  paths.estimateDepthCut = false;
  return paths;
}

// Adds the samples of a pixel to its elements. `top`: the first row of `sums` in the picture.
class BasisIntegrator : public Integrator {
 public:
  BasisIntegrator(const PathTracer& tracer, const LightGroups& groups, int top, LightStage& sums)
      : tracer_(tracer), groups_(groups), top_(top), sums_(sums) {}

  // Integrators with layers have a film with sums in double for each layer, which would be too
  // large; this writes to its own sums, only at the cameras' pixels.
  void sampleMany(const CameraSamples& cameras, PathContext& context,
                  std::span<Sample> samples) const override {
    struct Scratch {  // keeps its capacity
      std::array<std::vector<DirectedLight>, PathBatch::kMaxPaths> directed;
      std::vector<Rgb> groups;
      CameraSamples cameras;
    };
    thread_local Scratch found;
    const size_t count = groups_.names().size();
    found.groups.assign(cameras.size() * count, Rgb(0));
    found.cameras = cameras;
    found.cameras.writeLayers(found.groups, count);
    for (size_t i = 0; i < cameras.size(); ++i) found.directed[i].clear();
    GroupSums sums(groups_, context.lightRadiances, found.directed);
    context.groups = &sums;
    const std::span<const Rgb> radiances = PathBatch::traced(found.cameras, tracer_, context);
    context.groups = nullptr;
    for (size_t i = 0; i < cameras.size(); ++i) {
      samples[i] = radiances[i];
      const CameraPixel& pixel = cameras.pixel(i);
      if (!samples[i].defect)
        add(pixel.x, pixel.y - top_, found.directed[i],
            std::span(found.groups).subspan(i * count, count));
    }
  }

 private:
  void add(int x, int y, const std::vector<DirectedLight>& directed,
           std::span<const Rgb> groups) const {
    float* elements = sums_.elements.at(x, y);
    for (const DirectedLight& light : directed)
      sums_.basis.forValues(light.wi, [&](int element, float value) {
        for (int c = 0; c < 3; ++c) elements[3 * element + c] += value * light.throughput[c];
      });
    if (sums_.own.empty()) return;
    Rgb own = sums_.own.rgb(x, y);
    for (size_t i = groups_.rangeOf({})[1]; i < groups.size(); ++i) own += groups[i];
    sums_.own.setRgb(x, y, own);
  }

  const PathTracer& tracer_;
  const LightGroups& groups_;
  int top_;
  LightStage& sums_;
};

void divide(Image& sums, const Image& counts) {
  forRows(sums.width, sums.height, size_t(sums.channels), [&](int y) {
    for (int x = 0; x < sums.width; ++x) {
      const float scale = 1 / std::max(*counts.at(x, y), 1.0f);
      for (int c = 0; c < sums.channels; ++c) sums.at(x, y)[c] *= scale;
    }
  });
}

}  // namespace

BasisRenderer::BasisRenderer(const World& world, const Camera& camera, DirectionBasis basis,
                             const RenderSettings& settings)
    : world_(world),
      camera_(camera),
      basis_(std::move(basis)),
      settings_(plainSettings(settings)),
      white_(whiteMap()),
      lighting_(white_),
      groups_(world, lighting_),
      tracer_(world, lighting_, pathSettings(settings_)) {}

BasisRender BasisRenderer::render(int top, int count, const Progress& progress,
                                  const std::atomic<bool>& stop) const {
  RenderSettings settings = settings_;
  settings.crop = {0, top, settings.width, count};
  LightStage sums{basis_, Image(settings.width, count, 3 * basis_.size()), {}};
  if (groups_.names().size() > groups_.rangeOf({})[1]) sums.own = Image(settings.width, count, 3);
  const RenderResult result =
      chromeball::render(BasisIntegrator(tracer_, groups_, top, sums), world_, camera_, settings,
                         progress, stop, nullptr, nullptr);
  const Image counts = result.film.sampleCounts();
  divide(sums.elements, counts);
  if (!sums.own.empty()) divide(sums.own, counts);
  return {std::move(sums), result.film.mean(), result.invalid, result.interrupted};
}

}  // namespace chromeball

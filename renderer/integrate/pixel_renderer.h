// SPDX-License-Identifier: Apache-2.0
// Takes samples of single pixels.
#pragma once

#include "integrate/integrator.h"
#include "integrate/render.h"
#include "integrate/sample_sequence.h"
#include "scene/moving_camera.h"

namespace chromeball {

// The state of a thread that renders pixels.
struct PixelWorker {
  PathContext context;
  InvalidSamples invalid;
};

class PixelRenderer {
 public:
  // All arguments must outlive this.
  PixelRenderer(const Integrator& integrator, const World& world, const Camera& camera,
                const RenderSettings& settings, RenderResult& result);

  PixelWorker makeWorker() const;

  // Adds those of samples [from, to) of a pixel of the film that are the shard's to the result.
  // Thread-safe for different pixels.
  void render(PixelWorker& worker, int x, int y, uint32_t from, uint32_t to,
              const Beam& beam) const;

  // Of the camera rays through a grid of points, those that hit something.
  double fractionOfHits() const;

 private:
  // Samples of a half of a pixel that share a randomisation of the table; x and y are of the film.
  struct Block {
    int x, y, half;
    SampleSequence::Run run;
  };

  CameraRays raysAt(float time) const { return moving_ ? moving_->at(time) : cameraRays_; }
  void traceCameraRays(PixelSampler& sampler, uint32_t firstSample,
                       std::span<CameraSample> cameras) const;
  SampleSums renderBlock(PixelWorker& worker, const Block& block, const Beam& beam) const;
  void renderBatch(PixelWorker& worker, const Block& block, std::span<const CameraSample> cameras,
                   uint32_t firstSample, SampleSums& sums) const;
  void add(PixelWorker& worker, const Block& block, const CameraSample& camera,
           const Sample& sample, SampleSums& sums) const;
  float wideningOf(const Block& block, uint32_t index) const;

  const Integrator& integrator_;
  const World& world_;
  const RenderSettings& settings_;
  const Crop window_;
  CameraRays cameraRays_;
  std::optional<MovingCamera> moving_;  // camera
  const bool drawsTimes_;               // something moves while the shutter is open
  SampleSequence sequence_;
  SobolTable table_;
  RenderResult& result_;
};

}  // namespace chromeball

// SPDX-License-Identifier: Apache-2.0
// Takes samples of single pixels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "film/film.h"
#include "render/render.h"
#include "render/render_settings.h"
#include "scene/camera.h"
#include "transport/camera_samples.h"
#include "transport/integrator.h"

namespace chromeball {

// The points of the Sobol sequence for the samples of a pixel.

// The number of a pixel's first `samples` samples that belong to the half (Film).
constexpr uint32_t samplesOf(int half, uint32_t samples) {
  return samples / 2 + (half == 0 ? samples % 2 : 0);
}

// Each half of a pixel's samples is a sequence with its own randomisation. If it is longer than the
// table, the table is reused with another randomisation.
//
// The samples of a shard (render_settings.h) are points of the whole render's sequence.
class SampleSequence {
 public:
  explicit SampleSequence(const RenderSettings& settings);

  uint32_t tableSize() const { return tableSize_; }

  // Points of the table with randomisation number `table`.
  struct Run {
    uint64_t table;
    uint32_t first, count, stride;
  };

  // Calls visit(run) for those of a half's samples [begin, end) that are this shard's, in order.
  // The interval must not hold both repeated samples and others.
  template <class Visit>
  void forRuns(int half, uint32_t begin, uint32_t end, const Visit& visit) const {
    const uint64_t repeated = samplesOf(half, shard_.repeated);
    uint64_t at = begin, last = end, stride = 1;
    if (shard_.isConsecutive) {
      at += shard_.first() / 2, last += shard_.first() / 2;
    } else if (end > repeated) {
      stride = shard_.count;
      at += (shard_.index + stride - (begin - repeated) % stride) % stride;
    }
    while (at < last) {
      const uint64_t index = at % tableSize_;
      const uint64_t length = std::min(tableSize_ - index, last - at);
      const uint64_t count = (length + stride - 1) / stride;
      visit(Run{at / tableSize_, uint32_t(index), uint32_t(count), uint32_t(stride)});
      at += count * stride;
    }
  }

 private:
  Shard shard_;
  uint32_t tableSize_;
};

// Samples of a half of a pixel that share a randomisation of the table; x and y are of the film.
struct SampleBlock {
  int x = 0, y = 0;
  CameraPixel pixel;
  SampleSequence::Run run{};
  SampleSums sums;
};

// The state of a thread that renders pixels. The samples of several pixels are traced together, so
// that packets and lanes are full however few samples a pixel takes in a pass.
struct PixelWorker {
  PathContext context;
  InvalidSamples invalid;
  // Samples that wait, and their blocks, in the order of the samples.
  size_t blockCount = 0;
  CameraSamples cameras;
  std::vector<Sample> samples;
  std::vector<FirstHit> firsts;
  std::vector<Rgb> layers;  // of all samples
  std::vector<uint32_t> blockOf;
  std::vector<SampleBlock> blocks;
};

class PixelRenderer {
 public:
  // All arguments must outlive this.
  PixelRenderer(const Integrator& integrator, const World& world, const Camera& camera,
                const RenderSettings& settings, RenderResult& result);

  PixelWorker makeWorker() const;

  // Adds the shard's part of samples [from, to) of a pixel of the film to the result, at the latest
  // in finish(). Samples with another `randomization` (32 bits) are independent of them.
  // Thread-safe for different pixels.
  void render(PixelWorker& worker, int x, int y, uint32_t from, uint32_t to, const Beam& beam,
              uint32_t randomization) const;
  void finish(PixelWorker& worker) const;

  // The fraction of camera rays, through a grid of points, that hit something.
  double fractionOfHits() const;

 private:
  CameraRays raysAt(float time) const { return moving_ ? moving_->at(time) : cameraRays_; }
  void addBlock(PixelWorker& worker) const;
  void aim(const PixelSampler& sampler, CameraSamples& cameras) const;
  void aimSingly(PixelSampler& sampler, CameraSamples& cameras) const;
  void traceSamples(PixelWorker& worker) const;
  void endBlocks(PixelWorker& worker, size_t count) const;
  void add(PixelWorker& worker, size_t k) const;
  float wideningOf(const SampleBlock& block, uint32_t index) const;

  const Integrator& integrator_;
  const World& world_;
  const RenderSettings& settings_;
  const Crop window_;
  CameraRays cameraRays_;
  std::optional<MovingCamera> moving_;  // camera
  const bool drawsTimes_;               // something moves while the shutter is open
  SampleSequence sequence_;
  const size_t layerCount_;
  SobolTable table_;
  RenderResult& result_;
};

}  // namespace chromeball

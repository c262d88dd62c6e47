// SPDX-License-Identifier: Apache-2.0
#include "render/pixel_renderer.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "transport/integrator.h"
#include "transport/path_settings.h"

namespace chromeball {
namespace {

constexpr uint64_t kLargestTable = 4096;  // samples of a half that share one randomisation
constexpr uint64_t kAdaptive = 4;         // samples of a pixel relative to the mean; some have more

}  // namespace

SampleSequence::SampleSequence(const RenderSettings& settings) : shard_(settings.shard) {
  const uint64_t spread = settings.adaptive ? kAdaptive : 1,
                 half = (uint64_t(settings.samplesOfAll()) + 1) / 2;
  tableSize_ = uint32_t(std::bit_ceil(std::min(spread * half, kLargestTable)));
}

PixelRenderer::PixelRenderer(const Integrator& integrator, const World& world, const Camera& camera,
                             const RenderSettings& settings, RenderResult& result)
    : integrator_(integrator),
      world_(world),
      settings_(settings),
      window_(settings.window()),
      cameraRays_(camera, float(settings.width) / float(settings.height)),
      drawsTimes_(camera.motion || world.scene.moves),
      sequence_(settings),
      layerCount_(integrator.layers().size()),
      table_(sequence_.tableSize(),
             dimension::tabulated(std::min(settings.maxDepth, dimension::kTabulatedVertices) + 1),
             settings.seed),
      result_(result) {
  if (camera.motion) moving_.emplace(camera, float(settings.width) / float(settings.height));
}

PixelWorker PixelRenderer::makeWorker() const {
  const size_t batch = integrator_.batch();
  return {
      .context = {.sampler = PixelSampler(table_, settings_.seed), .clamp = Clamp(settings_.clamp)},
      .invalid = {},
      .cameras = std::vector<CameraSample>(batch),
      .samples = std::vector<Sample>(batch),
      .firsts = std::vector<FirstHit>(batch),
      .layers = std::vector<Rgb>(batch * layerCount_),
      .blockOf = std::vector<uint32_t>(batch),
      .blocks = std::vector<SampleBlock>(batch + 1)};
}

double PixelRenderer::fractionOfHits() const {
  constexpr int kPoints = 32;
  int hits = 0;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const vec2 point((float(i % kPoints) + 0.5f) / kPoints, (float(i / kPoints) + 0.5f) / kPoints);
    const float u = (float(window_.x) + point.x * float(window_.width)) / float(settings_.width);
    const float v = (float(window_.y) + point.y * float(window_.height)) / float(settings_.height);
    Ray ray;
    cameraRays_.ray(u, v, ray.origin, ray.direction);
    Hit hit;
    hits += world_.accel.intersect(ray, uint32_t(i), hit, integrator_.visible());
  }
  return double(hits) / (kPoints * kPoints);
}

void PixelRenderer::render(PixelWorker& worker, int x, int y, uint32_t from, uint32_t to,
                           const Beam& beam, uint32_t randomization) const {
  const uint64_t firstBlock = uint64_t(randomization) << 32;  // no render has as many
  const float u = (float(window_.x + x) + 0.5f) / float(settings_.width);
  const float v = (float(window_.y + y) + 0.5f) / float(settings_.height);
  const Beam own = cameraRays_.beamAt(beam, u, v);
  for (int half = 0; half < Film::kHalves; ++half)
    sequence_.forRuns(
        half, samplesOf(half, from), samplesOf(half, to), [&](const SampleSequence::Run& run) {
          assert(worker.blockCount < worker.blocks.size());
          SampleBlock& block = worker.blocks[worker.blockCount++];
          block.x = x, block.y = y, block.half = half, block.run = run, block.sums = {};
          worker.context.sampler.set(
              block.numbers, uint32_t(window_.x + x), uint32_t(window_.y + y),
              firstBlock + Film::kHalves * run.table + uint64_t(half), run.first, run.stride);
          addBlock(worker, own);
        });
}

// Takes the samples of the last block; those that fill the arrays are traced with all before.
void PixelRenderer::addBlock(PixelWorker& worker, const Beam& beam) const {
  const bool wantsFirst = !result_.aovs.empty() || !result_.features.empty();
  for (uint32_t i = 0; i < worker.blocks[worker.blockCount - 1].run.count; ++i) {
    if (worker.sampleCount == worker.cameras.size()) {
      traceSamples(worker);
      endBlocks(worker, worker.blockCount - 1);
    }
    const SampleBlock& block = worker.blocks[worker.blockCount - 1];
    const size_t k = worker.sampleCount++;
    if (wantsFirst) worker.firsts[k] = {};
    worker.blockOf[k] = uint32_t(worker.blockCount - 1);
    worker.cameras[k] = {.x = window_.x + block.x,
                         .y = window_.y + block.y,
                         .half = block.half,
                         .pixel = &block.numbers,
                         .index = i,
                         .beam = beam,
                         .widening = wideningOf(block, i),
                         .first = wantsFirst ? &worker.firsts[k] : nullptr,
                         .layers = std::span(worker.layers).subspan(k * layerCount_, layerCount_)};
  }
}

void PixelRenderer::finish(PixelWorker& worker) const {
  traceSamples(worker);
  endBlocks(worker, worker.blockCount);
}

// Adds the first blocks to the film; the rest goes on.
void PixelRenderer::endBlocks(PixelWorker& worker, size_t count) const {
  for (size_t k = 0; k < count; ++k) {
    const SampleBlock& block = worker.blocks[k];
    result_.film.add(block.x, block.y, block.half, block.sums);
  }
  if (count > 0 && count < worker.blockCount) std::swap(worker.blocks[0], worker.blocks[count]);
  worker.blockCount -= count;
}

// Generates and traces camera rays.
void PixelRenderer::traceCameraRays(PixelSampler& sampler, std::span<CameraSample> cameras) const {
  for (CameraSample& camera : cameras) {
    camera.start(sampler);
    const vec2 offset = sampler.get2(dimension::kPixel);
    const float u = (float(camera.x) + offset.x) / float(settings_.width);
    const float v = (float(camera.y) + offset.y) / float(settings_.height);
    Ray& ray = camera.ray;
    if (drawsTimes_) ray.time = sampler.time();
    const auto aim = [&](const CameraRays& rays) {
      if (rays.hasLens())
        rays.ray(u, v, sampler.get2(dimension::kLens), ray.origin, ray.direction);
      else
        rays.ray(u, v, ray.origin, ray.direction);
    };
    moving_ ? aim(moving_->at(ray.time)) : aim(cameraRays_);
  }
  findFirstHits(world_, cameras, integrator_.visible(), sampler);
}

float PixelRenderer::wideningOf(const SampleBlock& block, uint32_t index) const {
  if (!settings_.regularize) return 0;
  const uint64_t sample = Film::kHalves * (block.run.table * table_.size() + block.run.first +
                                           index * block.run.stride) +
                          uint64_t(block.half);
  return regularizationWidth(
      uint32_t(std::min<uint64_t>(sample, std::numeric_limits<uint32_t>::max())));
}

void PixelRenderer::traceSamples(PixelWorker& worker) const {
  const auto cameras = std::span(worker.cameras).first(worker.sampleCount);
  const auto samples = std::span(worker.samples).first(worker.sampleCount);
  traceCameraRays(worker.context.sampler, cameras);
  std::fill_n(worker.layers.begin(), cameras.size() * layerCount_, Rgb(0));
  integrator_.sampleMany(cameras, worker.context, samples);
  for (size_t k = 0; k < cameras.size(); ++k)
    add(worker, worker.blocks[worker.blockOf[k]], cameras[k], samples[k]);
  worker.sampleCount = 0;
}

void PixelRenderer::add(PixelWorker& worker, SampleBlock& block, const CameraSample& camera,
                        const Sample& sample) const {
  const int x = block.x, y = block.y, half = block.half;
  if (sample.defect) {
    worker.invalid.add(*sample.defect, camera.x, camera.y);
    result_.aovs.add(x, y, *sample.defect);
  } else {
    block.sums.add(sample.radiance);
    if (!result_.layers.empty()) result_.layers.add(x, y, half, camera.layers);
  }
  if (camera.first) {
    camera.first->depth = raysAt(camera.ray.time).depth(camera.ray.direction, camera.first->depth);
    if (!result_.aovs.empty()) result_.aovs.add(x, y, *camera.first);
    if (!result_.features.empty() && !sample.defect)
      result_.features.add(x, y, half, *camera.first, sample.radiance);
  }
}

}  // namespace chromeball

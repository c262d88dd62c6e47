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
      .cameras = {},
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
          block.x = x, block.y = y, block.run = run, block.sums = {};
          CameraPixel& pixel = block.pixel;
          pixel.x = window_.x + x, pixel.y = window_.y + y, pixel.half = half, pixel.beam = own;
          worker.context.sampler.set(pixel.numbers, uint32_t(pixel.x), uint32_t(pixel.y),
                                     firstBlock + Film::kHalves * run.table + uint64_t(half),
                                     run.first, run.stride);
          addBlock(worker);
        });
}

// Takes the samples of the last block; those that fill the arrays are traced with all before.
void PixelRenderer::addBlock(PixelWorker& worker) const {
  for (uint32_t i = 0; i < worker.blocks[worker.blockCount - 1].run.count; ++i) {
    if (worker.cameras.size() == worker.samples.size()) {
      traceSamples(worker);
      endBlocks(worker, worker.blockCount - 1);
    }
    const SampleBlock& block = worker.blocks[worker.blockCount - 1];
    worker.blockOf[worker.cameras.size()] = uint32_t(worker.blockCount - 1);
    worker.cameras.add(block.pixel, worker.context.sampler, i, wideningOf(block, i));
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
    result_.film.add(block.x, block.y, block.pixel.half, block.sums);
  }
  if (count > 0 && count < worker.blockCount) std::swap(worker.blocks[0], worker.blocks[count]);
  worker.blockCount -= count;
}

// Camera rays in lanes.
void PixelRenderer::aim(const PixelSampler& sampler, CameraSamples& cameras) const {
  using L = LanesOf<Float8>;
  const vec3& origin = cameraRays_.origin();
  for (size_t i = 0; i < cameras.size(); i += L::kCount) {
    std::array<float, L::kCount> u{}, v{};
    for (size_t k = 0; k < std::min<size_t>(L::kCount, cameras.size() - i); ++k) {
      const PixelSampler::Sample& numbers = cameras.numbers(i + k);
      const CameraPixel& pixel = cameras.pixel(i + k);
      u[k] = float(pixel.x) + toUnit(sampler.bits(numbers, dimension::kPixel));
      v[k] = float(pixel.y) + toUnit(sampler.bits(numbers, dimension::kPixel + 1));
    }
    cameras.setRays(i, {L::splat(origin.x), L::splat(origin.y), L::splat(origin.z)},
                    cameraRays_.directions(loadLanes(u.data()) / float(settings_.width),
                                           loadLanes(v.data()) / float(settings_.height)));
  }
}

void PixelRenderer::aimSingly(PixelSampler& sampler, CameraSamples& cameras) const {
  for (size_t i = 0; i < cameras.size(); ++i) {
    const CameraPixel& pixel = cameras.pixel(i);
    sampler.startSample(cameras.numbers(i));
    const vec2 offset = sampler.get2(dimension::kPixel);
    const float u = (float(pixel.x) + offset.x) / float(settings_.width);
    const float v = (float(pixel.y) + offset.y) / float(settings_.height);
    Ray ray{};
    if (drawsTimes_) ray.time = sampler.time();
    const auto aimWith = [&](const CameraRays& rays) {
      if (rays.hasLens())
        rays.ray(u, v, sampler.get2(dimension::kLens), ray.origin, ray.direction);
      else
        rays.ray(u, v, ray.origin, ray.direction);
    };
    moving_ ? aimWith(moving_->at(ray.time)) : aimWith(cameraRays_);
    cameras.setRay(i, ray);
  }
}

float PixelRenderer::wideningOf(const SampleBlock& block, uint32_t index) const {
  if (!settings_.regularize) return 0;
  const uint64_t sample = Film::kHalves * (block.run.table * table_.size() + block.run.first +
                                           index * block.run.stride) +
                          uint64_t(block.pixel.half);
  return regularizationWidth(
      uint32_t(std::min<uint64_t>(sample, std::numeric_limits<uint32_t>::max())));
}

void PixelRenderer::traceSamples(PixelWorker& worker) const {
  CameraSamples& cameras = worker.cameras;
  const size_t count = cameras.size();
  if (count == 0) return;  // no pixel of a tile needs more samples, or no shard's
  const bool wantsFirst = !result_.aovs.empty() || !result_.features.empty();
  const auto firsts = std::span(worker.firsts).first(wantsFirst ? count : 0);
  const auto layers = std::span(worker.layers).first(count * layerCount_);
  std::ranges::fill(firsts, FirstHit{});
  std::ranges::fill(layers, Rgb(0));
  cameras.writeFirstHits(firsts);
  cameras.writeLayers(layers, layerCount_);
  if (cameraRays_.isPlain() && !drawsTimes_)
    aim(worker.context.sampler, cameras);
  else
    aimSingly(worker.context.sampler, cameras);
  cameras.findHits(world_, integrator_.visible());
  integrator_.sampleMany(cameras, worker.context, std::span(worker.samples).first(count));
  for (size_t k = 0; k < count; ++k) add(worker, k);
  cameras.clear();
}

// Adds sample `k` to its block, and its layers to their films.
void PixelRenderer::add(PixelWorker& worker, size_t k) const {
  const Sample& sample = worker.samples[k];
  SampleBlock& block = worker.blocks[worker.blockOf[k]];
  const CameraPixel& pixel = block.pixel;
  const int x = block.x, y = block.y;
  if (sample.defect) {
    worker.invalid.add(*sample.defect, pixel.x, pixel.y);
    result_.aovs.add(x, y, *sample.defect);
  } else {
    block.sums.add(sample.radiance);
    if (!result_.layers.empty())
      result_.layers.add(x, y, pixel.half,
                         std::span(worker.layers).subspan(k * layerCount_, layerCount_));
  }
  const CameraSamples& cameras = worker.cameras;
  if (FirstHit* const first = cameras.first(k)) {
    first->depth = raysAt(cameras.time(k)).depth(cameras.direction(k), first->depth);
    if (!result_.aovs.empty()) result_.aovs.add(x, y, *first);
    if (!result_.features.empty() && !sample.defect)
      result_.features.add(x, y, pixel.half, *first, sample.radiance);
  }
}

}  // namespace chromeball
